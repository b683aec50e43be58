//@ args: check
//@ snapshot
#include "KMotionDef.h"
#include "helper_by_itself.c"

int Debounce(int bit)
{
    return ReadBit(bit);
}

main()
{
    if (Debounce(1)) SetBit(46);
}
