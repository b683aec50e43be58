#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 10; i++)
        persist.UserData[40 + i] += i;
    persist.UserData[50] = 0;
    StartThread(2);
    while (!persist.UserData[50])
        WaitNextTimeSlice();
    for (i = 0; i < 10; i++)
        persist.UserData[40 + i] += 1;
}
