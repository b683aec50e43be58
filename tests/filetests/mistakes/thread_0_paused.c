//@ says: thread 1 at thread_0_paused.c:6:5 in `main`: PauseThread(0): there are threads 1 to 7
#include "KMotionDef.h"

main()
{
    PauseThread(0);
}
