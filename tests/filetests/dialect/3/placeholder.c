//@ exit: 1
#include "KMotionDef.h"

main()
{
    if (ReadBit(xxx)) ClearBit(46); //~ error: xxx
}
