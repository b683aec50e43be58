#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 500; i++)
    {
        if (ReadBit(137))
            persist.UserData[75] = 0;
        else
            persist.UserData[75] = 500;
        WaitNextTimeSlice();
    }
}
