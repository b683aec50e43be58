// cc67: run --for 5 also 2:feed_2.c
#include "KMotionDef.h"

main()
{
    double *feed = (double *)&persist.UserData[60];
    int i;

    for (i = 0; i < 20; i++)
    {
        WaitNextTimeSlice();
        *feed = i & 1 ? 12.7 : -183.35;
    }
    persist.UserData[62] = 1;
    while (persist.UserData[62])
        WaitNextTimeSlice();
    printf("%d torn\n", persist.UserData[63]);
}
