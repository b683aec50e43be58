#include "KMotionDef.h"

void ask(int code, int value)
{
    MutexLock(&persist.UserData[9]);
    persist.UserData[101] = value;
    persist.UserData[100] = code;
    while (persist.UserData[100] > 0)
        ;
    MutexUnlock(&persist.UserData[9]);
}

main()
{
    int i;

    for (i = 0; i < 4; i++)
        ask(PC_COMM_MCODE, i);
}
