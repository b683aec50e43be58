//@ args: 2:parts/moves_back.c
//@ says: thread 2 at moves_back.c:6:5 in `main`: Move: axis 0 is still moved by thread 1, whose motion ends here
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 50000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
