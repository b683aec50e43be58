//@ prints: 0 1
#include "KMotionDef.h"

int take(int count)
{
    MutexLock(&persist.UserData[50]);
    if (count == 0)
    {
        MutexUnlock(&persist.UserData[50]);
        return 0;
    }
    MutexUnlock(&persist.UserData[50]);
    return 1;
}

main()
{
    printf("%d %d\n", take(0), take(5));
}
