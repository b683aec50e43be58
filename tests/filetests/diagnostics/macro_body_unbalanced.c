//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

#define MM (400.0 * 25.4

main()
{
    Move(0, 10 * MM);
    SetBit(46);
}
