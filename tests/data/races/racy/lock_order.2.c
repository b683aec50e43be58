#include "KMotionDef.h"

main()
{
    int i;

    Delay_sec(0.02);
    for (i = 0; i < 50; i++)
    {
        MutexLock(&persist.UserData[9]);
        MutexLock(&persist.UserData[8]);  // <-
        persist.UserData[5]++;
        MutexUnlock(&persist.UserData[8]);
        MutexUnlock(&persist.UserData[9]);
        WaitNextTimeSlice();
    }
}
