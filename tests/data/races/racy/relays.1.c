// race-relays:
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 50; i++)
    {
        SetBit(152);  // <-
        Delay_sec(0.0005);
        ClearBit(152);  // <-
    }
}
