//@ args: check
//@ snapshot
#include "KMotionDef.h"

main()
{
    SetBit(46);
}
