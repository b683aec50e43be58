#include "KMotionDef.h"

main()
{
    double *feed = (double *)&persist.UserData[60], sum = 0;

    while (!persist.UserData[62])
    {
        MutexLock(&persist.UserData[9]);
        sum += *feed;
        MutexUnlock(&persist.UserData[9]);
    }
    persist.UserData[63] = sum;
}
