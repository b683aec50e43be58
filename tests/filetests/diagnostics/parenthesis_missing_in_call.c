//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    Move(0, 1000;
    SetBit(46);
}
