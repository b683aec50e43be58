//@ prints: 1
#include "KMotionDef.h"

int lock;

main()
{
    persist.UserData[50] = (int)&lock;
    MutexLock(&lock);
    persist.UserData[20]++;
    MutexUnlock(&lock);
    printf("%d\n", persist.UserData[20]);
}
