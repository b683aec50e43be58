//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    void Lamp(int on)
    {
        if (on) SetBit(46);
    }

    Lamp(1);
}
