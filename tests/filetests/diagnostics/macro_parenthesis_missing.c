//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

#define MM(x) ((x) * 400.0)

main()
{
    Move(0, MM(10);
    SetBit(46);
}
