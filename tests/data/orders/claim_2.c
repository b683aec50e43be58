// cc67: part of claim.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 20; i++)
    {
        WaitNextTimeSlice();
        while (persist.UserData[10])
            ;
        persist.UserData[10] = 2;
        persist.UserData[11] = persist.UserData[11] + 1;
        persist.UserData[10] = 0;
    }
    persist.UserData[14] = 1;
}
