//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main();
{
    SetBit(46);
}
