#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 100; i++)
    {
        MutexLock(&persist.UserData[8]);
        MutexLock(&persist.UserData[9]);
        persist.UserData[5]++;
        MutexUnlock(&persist.UserData[9]);
        MutexUnlock(&persist.UserData[8]);
    }
}
