//@ says: thread 1 at thread_0_paused.c:6:5 in `main`: PauseThread(0): no such thread (1-7)
#include "KMotionDef.h"

main()
{
    PauseThread(0);
}
