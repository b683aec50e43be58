//@ args: check
//@ snapshot
#include "KMotionDef.h"

main()
{
    if (ReadBit(1));
    {
        SetBit(46);
    }
}
