//@ says: thread 1 at return_with_a_lock.c:6:5 in `main`: took the lock `persist.UserData[50]` and has ended without MutexUnlock: the next thread that needs it waits forever
#include "KMotionDef.h"

main()
{
    MutexLock(&persist.UserData[50]);
    if (persist.UserData[20] == 0) return 1;
    persist.UserData[20]--;
    MutexUnlock(&persist.UserData[50]);
}
