#include "KMotionDef.h"

main()
{
    int scale = persist.UserData[35];  // <-
    int i;

    for (i = 0; i < 500; i++)
    {
        persist.UserData[37] = i * scale;
        WaitNextTimeSlice();
    }
}
