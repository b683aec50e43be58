//@ args: check
//@ snapshot
#include "KMotionDef.h"

main()
{
    int state = 0;

    while (state = ReadBit(1))
    {
        SetBit(46);
    }
}
