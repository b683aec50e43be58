//@ args: check
//@ snapshot
#include "KMotionDef.h"

int lock;

main()
{
    int n = 0;
    MutexLock(lock);
    sscanf("12", "%d", n);
    MutexUnlock(&lock);
    printf("%d\n", n);
}
