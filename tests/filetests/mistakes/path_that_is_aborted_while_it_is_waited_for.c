//@ args: --machine parts/disables.toml
//@ says: thread 1 at path_that_is_aborted_while_it_is_waited_for.c:21:13 in `main`: CheckDoneXYZABC or CheckDoneBuf is -1: an axis was disabled before the path ended, which `while (!CheckDoneXYZABC())` takes for its end
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
    MoveXYZABC(9000, 9000, 0, 0, 0, 0);
    while (!CheckDoneXYZABC()) WaitNextTimeSlice();
    Zero(1);
}
