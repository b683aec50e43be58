// cc67: part of order.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 1; i <= 8; i++)
    {
        while (!persist.UserData[40])
            WaitNextTimeSlice();
        persist.UserData[50 + i] = persist.UserData[41];
        persist.UserData[40] = 0;
    }
}
