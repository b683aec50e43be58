//@ args: --machine parts/gantry.toml
//@ says: the sides of a gantry, axes 0 and 1, are 100.
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch1->InputMode = NO_INPUT_MODE;
    ch1->OutputMode = STEP_DIR_MODE;
    ch1->Vel = 10000;
    ch1->Accel = 100000;
    ch1->Jerk = 1e6;
    EnableAxisDest(0, 0);
    EnableAxisDest(1, 0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
