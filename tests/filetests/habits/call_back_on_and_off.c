// Each run switches the call-back the other way; what it does between is counted.
//@ args: run 2:parts/toggles.c
//@ prints: on
//@ prints: worked
//@ prints: off
#include "KMotionDef.h"

int i;

main()
{
    for (i = 0; i < 2; i++)
    {
        persist.UserData[80] = 1;
        StartThread(2);
        while (persist.UserData[80]) WaitNextTimeSlice();
        Delay_sec(0.05);
        if (i == 0 && persist.UserData[81] > 100) printf("worked\n");
    }
}
