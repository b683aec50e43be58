//@ args: check
//@ says: warning[local-lock]: `lock` is a local variable, which no other thread can lock
//@ says: lock_in_a_local.c:9:5
#include "KMotionDef.h"

main()
{
    int lock = 0;
    MutexLock(&lock);
    persist.UserData[20]++;
    MutexUnlock(&lock);
}
