//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    while (!Readbit(46)) ;
    ClearBti(47);
}
