//@ args: check
//@ says: warning[absolute-time]: `WaitUntil` takes a time since power-up: 0.5 s are over soon after it
//@ says: wait_until_used_as_a_delay.c:9:5
#include "KMotionDef.h"

main()
{
    SetBit(46);
    WaitUntil(0.5);
    ClearBit(46);
}
