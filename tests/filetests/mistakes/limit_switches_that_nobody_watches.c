//@ args: --machine parts/limits.toml
//@ prints: at 1000
//@ says: thread 1 at limit_switches_that_nobody_watches.c:16:5 in `main`: axis 0 has LimitSwitchNegBit = 136, where its switch is, but LimitSwitchOptions does not watch it: the axis runs through it
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 5000;
    ch0->Accel = 50000;
    ch0->Jerk = 5e5;
    ch0->LimitSwitchNegBit = 136;
    ch0->LimitSwitchPosBit = 137;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    while (!CheckDone(0))
        WaitNextTimeSlice();
    printf("at %.0f\n", ch0->Dest);
}
