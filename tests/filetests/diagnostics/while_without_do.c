//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    do
    {
        SetBit(46);
    }

    ClearBit(46);
}
