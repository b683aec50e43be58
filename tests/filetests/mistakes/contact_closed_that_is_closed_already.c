//@ args: --set inputs.idle_high=[140] --stim parts/closed_again.stim
//@ says: closed_again.stim:1:1: bit 140 was 1 already, as `idle_high` says: this action changes nothing
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 20000);
    while (CheckDone(0) == 0)
    {
        if (!ReadBit(140)) DisableAxis(0);
        WaitNextTimeSlice();
    }
}
