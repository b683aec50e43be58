//@ says: thread 1 at soft_limits_swapped.c:14:5 in `main`: Move: SoftLimitNeg of axis 0 is 1000 and SoftLimitPos -1000: every place is beyond one of them
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->SoftLimitPos = -1000;
    ch0->SoftLimitNeg = 1000;
    EnableAxisDest(0, 0);
    Move(0, 500);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
