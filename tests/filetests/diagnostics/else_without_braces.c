//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    if (ReadBit(1))
        SetBit(46);
        SetBit(47);
    else
        ClearBit(46);
}
