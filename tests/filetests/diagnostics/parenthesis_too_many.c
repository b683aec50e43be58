//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    while (!CheckDone(0))) ;
    SetBit(46);
}
