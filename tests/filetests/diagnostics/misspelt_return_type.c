//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

viod Lamp(int on)
{
    if (on) SetBit(46); else ClearBit(46);
}

main()
{
    Lamp(1);
}
