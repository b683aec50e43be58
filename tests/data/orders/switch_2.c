// cc67: part of switch.c
#include "KMotionDef.h"

main()
{
    while (!persist.UserData[130])
        WaitNextTimeSlice();
    while (persist.UserData[130])
    {
        WaitNextTimeSlice();
        persist.UserData[131] = ReadBit(136);
    }
}
