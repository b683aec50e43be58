// cc67: run --for 5 also 2:bits_2.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 10; i++)
    {
        WaitNextTimeSlice();
        VirtualBits |= 1 << i;
    }
    while (!persist.UserData[21])
        WaitNextTimeSlice();
    printf("lamp %s\n", (VirtualBits & 0x3ff) == 0x3ff && (VirtualBits & 0x8000) ? "on" : "off");
}
