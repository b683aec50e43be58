//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    if (ReadBit(1))
    {
        SetBit(46)
    }
    ClearBit(47)
}
