// cc67: run --for 5 also 2:locks_2.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 5; i++)
    {
        WaitNextTimeSlice();
        MutexLock(&persist.UserData[30]);
        MutexLock(&persist.UserData[31]);
        persist.UserData[32]++;
        MutexUnlock(&persist.UserData[31]);
        MutexUnlock(&persist.UserData[30]);
    }
    while (!persist.UserData[33])
        WaitNextTimeSlice();
    printf("both\n");
}
