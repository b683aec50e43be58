#include "KMotionDef.h"

#define PUMP 0x2000

main()
{
    int i, k;

    for (i = 0; i < 2000; i++)
    {
        VirtualBits ^= PUMP;  // <-
        for (k = 0; k < i % 7; k++)
            ;
    }
}
