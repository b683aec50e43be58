//@ says: thread 1 at axis_enabled_after_its_move.c:11:5 in `main`: Move: axis 0 is disabled, so nothing moves
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    Move(0, 1000);
    EnableAxisDest(0, 0);
}
