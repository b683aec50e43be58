// cc67: part of locks.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 5; i++)
    {
        WaitNextTimeSlice();
        MutexLock(&persist.UserData[31]);
        MutexLock(&persist.UserData[30]);
        persist.UserData[32]++;
        MutexUnlock(&persist.UserData[30]);
        MutexUnlock(&persist.UserData[31]);
    }
    persist.UserData[33] = 1;
}
