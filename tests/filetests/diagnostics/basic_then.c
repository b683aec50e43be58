//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    if (ReadBit(1)) then
        SetBit(46);
    end if
}
