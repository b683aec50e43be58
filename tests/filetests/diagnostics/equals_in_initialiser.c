//@ args: check
//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int limit == 5;

    SetBit(limit);
}
