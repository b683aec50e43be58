// cc67: part of feed.c
#include "KMotionDef.h"

main()
{
    double *feed = (double *)&persist.UserData[60], now;

    while (!persist.UserData[62])
    {
        WaitNextTimeSlice();
        now = *feed;
        if (now != 0 && now != 12.7 && now != -183.35)
            persist.UserData[63]++;
    }
    persist.UserData[62] = 0;
}
