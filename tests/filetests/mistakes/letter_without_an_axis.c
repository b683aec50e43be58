//@ says: thread 1 at letter_without_an_axis.c:13:5 in `main`: MoveXYZABC: Y should go to 500, but DefineCoordSystem has given it no axis
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    DefineCoordSystem(0, -1, -1, -1);
    MoveXYZABC(0, 500, 0, 0, 0, 0);
    while (!CheckDoneXYZABC()) WaitNextTimeSlice();
}
