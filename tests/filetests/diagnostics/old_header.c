//@ args: check
//@ snapshot
#include "parts/old_header/KMotionDef.h"

main()
{
    SetBit(46);
    chan[1].P = 2;
}
