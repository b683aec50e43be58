//@ says: thread 1 at velocity_zero.c:13:5 in `main`: Move: Vel, Accel and Jerk of axis 0 are not all positive
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->Vel = 0;
    EnableAxisDest(0, 0);
    Move(0, 100);
}
