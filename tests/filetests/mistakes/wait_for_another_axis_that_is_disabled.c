//@ says: thread 1 at wait_for_another_axis_that_is_disabled.c:13:13 in `main`: CheckDone(1) asks about axis 1, but the thread moves axis 0, for which it never waits
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
    while (!CheckDone(1)) WaitNextTimeSlice();
}
