//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

void Main()
{
    SetBit(46);
}
