// cc67: run --for 5 also 2:counter_2.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 20; i++)
    {
        WaitNextTimeSlice();
        persist.UserData[20]++;
    }
    while (!persist.UserData[21])
        WaitNextTimeSlice();
    printf("%d\n", persist.UserData[20]);
}
