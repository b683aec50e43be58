#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 400; i++)
    {
        persist.UserData[5] = ReadBit(136);
        WaitNextTimeSlice();
    }
    persist.UserData[6] = 1;
}
