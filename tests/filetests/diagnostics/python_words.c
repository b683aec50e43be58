//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    if (ReadBit(1) and not ReadBit(2))
        SetBit(46);
}
