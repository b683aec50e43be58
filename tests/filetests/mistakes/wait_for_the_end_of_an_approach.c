//@ args: --for 3
//@ says: at the end, after 3.000 s of board time:
//@ says: thread 1 at wait_for_the_end_of_an_approach.c:16:27 in `main` has waited since 0.000 s for the end of the motion of axis 0
//@ says: axis 0: enabled, Dest 1000, Position 0, moves at 0 units/s: MoveExp has no end, so CheckDone stays 0
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    MoveExp(0, 1000, 0.1);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
