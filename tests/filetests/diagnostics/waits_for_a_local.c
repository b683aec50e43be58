//@ args: check
//@ snapshot
#include "KMotionDef.h"

main()
{
    int busy = ReadBit(136);
    while (busy) ;
    ClearBit(46);
}
