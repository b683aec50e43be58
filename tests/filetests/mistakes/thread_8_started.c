//@ says: thread 1 at thread_8_started.c:7:5 in `main`: StartThread(8): no such thread (1-7)
#include "KMotionDef.h"

main()
{
    int thread = 8;
    StartThread(thread);
}
