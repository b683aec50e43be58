//@ args: --stim parts/relay.stim
//@ says: expected_bit_that_is_an_input.c:11:5
//@ says: relay.stim:1:1: bit 3 is an input that nothing drives: SetBitDirection makes it an output, so this cannot fail
//@ says: relay.stim:2:1: bit 137 is an input that nothing drives, so this cannot fail
#include "KMotionDef.h"

main()
{
    SetBitDirection(0, 1);
    SetBit(0);
    SetBit(3);
    Delay_sec(0.25);
    ClearBit(3);
    ClearBit(0);
    Delay_sec(0.25);
}
