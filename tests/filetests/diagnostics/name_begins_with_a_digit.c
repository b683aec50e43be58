//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int 2nd = 5;

    SetBit(2nd);
}
