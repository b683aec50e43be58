//@ args: check
//@ says: warning[local-lock]: `lock` is a variable of this program, which no other thread can lock
//@ says: lock_in_a_global.c:10:5
#include "KMotionDef.h"

int lock;

main()
{
    MutexLock(&lock);
    persist.UserData[20]++;
    MutexUnlock(&lock);
}
