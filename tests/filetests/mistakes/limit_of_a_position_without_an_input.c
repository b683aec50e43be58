//@ args: --stim parts/position.stim
//@ says: position.stim:1:1: axis 0 has no input and stays at position 0 (`dest` is its target, `load` the place of its load), so this cannot fail
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 8000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
