#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 5; i++)
    {
        MutexLock(&persist.UserData[9]);
        persist.UserData[5]++;
        MutexUnlock(&persist.UserData[9]);
    }
}
