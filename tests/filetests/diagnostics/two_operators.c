//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int i = 5;

    if (i => 3) SetBit(46);
    if (i =! 3) SetBit(47);
    if (i <> 3) SetBit(48);
}
