//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

void setup()
{
    SetBitDirection(46, 1);
}

void loop()
{
    SetBit(46);
    Delay_sec(0.5);
}
