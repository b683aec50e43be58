//@ says: thread 1 at axis_disabled_on_its_path.c:21:5 in `main`: DisableAxis: axis 1 follows a path, which ends here for all its axes
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch1->InputMode = NO_INPUT_MODE;
    ch1->OutputMode = STEP_DIR_MODE;
    ch1->Vel = 10000;
    ch1->Accel = 100000;
    ch1->Jerk = 1e6;
    DefineCoordSystem(0, 1, -1, -1);
    EnableAxisDest(0, 0);
    EnableAxisDest(1, 0);
    MoveXYZABC(5000, 5000, 0, 0, 0, 0);
    Delay_sec(0.05);
    DisableAxis(1);
    while (!CheckDoneXYZABC()) WaitNextTimeSlice();
}
