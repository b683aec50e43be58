//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    printf("homing finished);
    SetBit(46);
    printf("next\n");
}
