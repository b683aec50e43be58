//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    G0 X10 Y20
    M3 S1000
    SetBit(46);
}
