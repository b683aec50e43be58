//@ args: --machine parts/closed_limits.toml
//@ says: thread 1 at limit_switch_bits_that_are_not_used.c:15:5 in `main`: EnableAxisDest: axis 0 watches bit 0, not LimitSwitchNegBit = 136, because bit 8 of LimitSwitchOptions is 0: add 0x100
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->LimitSwitchOptions = 0x003;
    ch0->LimitSwitchNegBit = 136;
    ch0->LimitSwitchPosBit = 137;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
