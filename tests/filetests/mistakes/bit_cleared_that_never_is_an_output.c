//@ says: thread 1 at bit_cleared_that_never_is_an_output.c:6:5 in `main`: ClearBit(21): bit 21 is an input, so its pin does not change: call SetBitDirection(21, 1) first
#include "KMotionDef.h"

main()
{
    ClearBit(21);
}
