// cc67: run --for 5 also 2:ring_2.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 1; i <= 20; i++)
    {
        WaitNextTimeSlice();
        persist.UserData[80]++;
        persist.UserData[121 + i] = i;
    }
    while (!persist.UserData[150])
        WaitNextTimeSlice();
    printf("sum %d\n", persist.UserData[151]);
}
