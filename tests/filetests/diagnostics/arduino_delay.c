//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    SetBit(46);
    delay(100);
    ClearBit(46);
}
