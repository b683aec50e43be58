//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

int pressed(int bit)
{
    return ReadBit(bit);
}

main()
{
    for (;;)
    {
        WaitNextTimeSlice();
        if (pressed(1))
        {
            SetBit(46);
            Delay_sec(0.5);
        else
            ClearBit(46);
    }
}
