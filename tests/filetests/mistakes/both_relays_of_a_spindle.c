//@ args: --machine parts/relay_spindle.toml
//@ says: thread 1 at both_relays_of_a_spindle.c:9:5 in `main`: SetBit(155): output 154 is on as well, so the motor is switched to both directions at once: clear one before the other is set
#include "KMotionDef.h"

main()
{
    SetBit(154);
    Delay_sec(1);
    SetBit(155);
    Delay_sec(0.1);
    ClearBit(154);
}
