#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 50; i++)
    {
        SetStateBit(157, i & 1);  // <-
        WaitNextTimeSlice();
    }
}
