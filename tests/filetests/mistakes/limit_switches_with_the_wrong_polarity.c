//@ args: --machine parts/closed_limits.toml
//@ prints: Neg Limit Disabled Axis:0
//@ says: thread 1 at limit_switches_with_the_wrong_polarity.c:16:5 in `main`: EnableAxisDest: LimitSwitchNegBit of axis 0 is 136, which is 1 and so counts as active, but nothing presses the switch: change bit 2 of LimitSwitchOptions
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->LimitSwitchOptions = 0x103;
    ch0->LimitSwitchNegBit = 136;
    ch0->LimitSwitchPosBit = 137;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
