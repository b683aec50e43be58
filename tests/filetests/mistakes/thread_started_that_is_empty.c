//@ says: thread 1 at thread_started_that_is_empty.c:6:5 in `main`: StartThread(5): no program is loaded in thread 5
#include "KMotionDef.h"

main()
{
    StartThread(5);
}
