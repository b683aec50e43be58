//@ args: --machine parts/two_axes.toml --stim parts/envelope.stim
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    SetBit(152);
    Move(0, 2000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    ClearBit(152);
}
