// cc67: run --for 5 also 2:claim_2.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 20; i++)
    {
        WaitNextTimeSlice();
        while (persist.UserData[10])
            ;
        persist.UserData[10] = 1;
        persist.UserData[11] = persist.UserData[11] + 1;
        persist.UserData[10] = 0;
    }
    persist.UserData[13] = 1;
    while (!persist.UserData[14])
        WaitNextTimeSlice();
    printf("%d\n", persist.UserData[11]);
}
