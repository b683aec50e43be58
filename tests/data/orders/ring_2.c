// cc67: part of ring.c
#include "KMotionDef.h"

main()
{
    int taken = 0, sum = 0;

    while (taken < 20)
    {
        WaitNextTimeSlice();
        while (taken < persist.UserData[80])
        {
            taken++;
            sum += persist.UserData[121 + taken];
        }
    }
    persist.UserData[151] = sum;
    persist.UserData[150] = 1;
}
