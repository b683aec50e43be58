//@ exit: 1
//@ says: did you mean `ReadBit`?
#include "KMotionDef.h"

main()
{
    while (!Readbit(46)) ; //~ error: Readbit
}
