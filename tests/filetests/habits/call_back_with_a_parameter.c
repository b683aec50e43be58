// A call-back is void(void); one with a parameter is refused.
//@ exit: 1
#include "KMotionDef.h"

void Blink(int bit)
{
    SetStateBit(bit, !ReadBit(bit));
}

main()
{
    UserCallBack = Blink; //~ error: cannot convert
}
