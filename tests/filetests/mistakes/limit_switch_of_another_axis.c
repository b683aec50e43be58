//@ args: --machine parts/two_homes.toml
//@ says: thread 1 at limit_switch_of_another_axis.c:15:5 in `main`: Move: LimitSwitchNegBit of axis 0 is 137, a switch of axis 1
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->LimitSwitchOptions = 0x101;
    ch0->LimitSwitchNegBit = 137;
    EnableAxisDest(0, 0);
    Move(0, -500);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
