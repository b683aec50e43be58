// cc67: run --for 5 also 2:order_2.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 1; i <= 8; i++)
    {
        WaitNextTimeSlice();
        persist.UserData[40] = 1;
        persist.UserData[41] = i;
        while (persist.UserData[40])
            WaitNextTimeSlice();
    }
    printf("%d %d %d %d %d %d %d %d\n", persist.UserData[51], persist.UserData[52], persist.UserData[53],
        persist.UserData[54], persist.UserData[55], persist.UserData[56], persist.UserData[57], persist.UserData[58]);
}
