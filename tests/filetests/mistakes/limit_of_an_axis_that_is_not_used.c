//@ args: --machine parts/drill.toml --stim parts/depth.stim
//@ says: depth.stim:1:1: axis 3 is never used in this run, so this cannot fail
//@ says: depth.stim:2:1: bit 137 is an input that nothing drives, so this cannot fail
//@ says: depth.stim:3:1: DAC 1 is never written in this run, so this cannot fail
#include "KMotionDef.h"

main()
{
    ch2->InputMode = NO_INPUT_MODE;
    ch2->OutputMode = STEP_DIR_MODE;
    ch2->Vel = 10000;
    ch2->Accel = 100000;
    ch2->Jerk = 1e6;
    EnableAxisDest(2, 0);
    DAC(0, 1500);
    Move(2, -8000);
    while (!CheckDone(2)) WaitNextTimeSlice();
}
