// race-update: VirtualBits
#include "KMotionDef.h"

#define DOOR 0x10

main()
{
    int i;

    for (i = 0; i < 2000; i++)
    {
        VirtualBits |= DOOR;  // <-
        VirtualBits &= ~DOOR;
    }
}
