//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

int Homed(int axis)
{
    retrun ReadBit(axis);
}

main()
{
    if (Homed(0)) SetBit(46);
}
