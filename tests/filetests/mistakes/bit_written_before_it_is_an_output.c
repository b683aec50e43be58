//@ says: thread 1 at bit_written_before_it_is_an_output.c:6:5 in `main`: SetBit(20): bit 20 is an input, so its pin does not change: call SetBitDirection(20, 1) first
#include "KMotionDef.h"

main()
{
    SetBit(20);
    Delay_sec(1);
}
