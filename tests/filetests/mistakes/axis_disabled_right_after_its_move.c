//@ says: thread 1 at axis_disabled_right_after_its_move.c:13:5 in `main`: DisableAxis: the move of axis 0 to 1000 is ended before it starts: wait with `while (!CheckDone(0));` in between
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    DisableAxis(0);
}
