//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

void Lamp(int on)
{
    if (on)
        SetBit(46);
    else
        ClearBit(46);

main()
{
    Lamp(1);
}
