//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    If (ReadBit(1))
    {
        SetBit(46);
    }
    While (ReadBit(2)) ;
}
