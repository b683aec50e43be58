#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 1000; i++)
    {
        MutexLock(&persist.UserData[9]);
        persist.UserData[5] += 3;
        persist.UserData[6]++;
        MutexUnlock(&persist.UserData[9]);
    }
}
