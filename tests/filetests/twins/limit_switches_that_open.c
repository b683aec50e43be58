//@ args: --machine ../mistakes/parts/closed_limits.toml
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->LimitSwitchOptions = 0x10f;
    ch0->LimitSwitchNegBit = 136;
    ch0->LimitSwitchPosBit = 137;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
