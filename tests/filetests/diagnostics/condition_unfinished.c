//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    if (ReadBit(1) && ! ReadBit(2) && )
        SetBit(46);
}
