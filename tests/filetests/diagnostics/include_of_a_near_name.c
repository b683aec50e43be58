//@ exit: 1
//@ snapshot
#include "KMotionDefs.h"

main()
{
    SetBit(46);
}
