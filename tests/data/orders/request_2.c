// cc67: part of request.c
#include "KMotionDef.h"

main()
{
    while (persist.UserData[70] != -1)
    {
        WaitNextTimeSlice();
        if (persist.UserData[70] == 1)
        {
            persist.UserData[72] = persist.UserData[71];
            Delay_sec(0.0008);
            persist.UserData[70] = 0;
        }
    }
}
