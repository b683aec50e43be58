#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 100; i++)
    {
        persist.UserData[70] = 1;
        while (persist.UserData[70])
            WaitNextTimeSlice();
    }
    persist.UserData[71] = 1;
}
