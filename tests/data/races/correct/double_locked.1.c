#include "KMotionDef.h"

main()
{
    double *feed = (double *)&persist.UserData[60];
    int i;

    for (i = 0; i < 1000; i++)
    {
        MutexLock(&persist.UserData[9]);
        *feed = i * 0.1;
        MutexUnlock(&persist.UserData[9]);
    }
    persist.UserData[62] = 1;
}
