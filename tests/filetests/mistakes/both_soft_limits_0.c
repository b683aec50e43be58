//@ says: thread 1 at both_soft_limits_0.c:14:5 in `main`: Move: axis 0 is at 10, beyond SoftLimitPos = 0, so it does not move further
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->SoftLimitPos = 0;
    ch0->SoftLimitNeg = 0;
    EnableAxisDest(0, 10);
    Move(0, 500);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
