//@ args: --for 1
//@ says: thread 1 at move_to_no_number.c:14:5 in `main`: Move: inf is not a valid position or speed: the axis moves on without an end
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    double zero = 0;
    EnableAxisDest(0, 0);
    Move(0, 1 / zero);
}
