//@ args: --for 1 2:parts/keeps_a_lock.c
//@ says: thread 1 at lock_that_an_ended_thread_keeps.c:8:5 in `main` has waited since 0.000 s for a lock that thread 2 has, taken at keeps_a_lock.c:5:5 in `main`, which has ended without MutexUnlock
#include "KMotionDef.h"

main()
{
    Delay_sec(0.01);
    MutexLock((int *)&persist.UserData[30]);
    MutexUnlock((int *)&persist.UserData[30]);
}
