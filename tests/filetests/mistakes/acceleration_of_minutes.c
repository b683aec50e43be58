//@ args: --for 1
//@ says: thread 1 at acceleration_of_minutes.c:16:5 in `main`: Move: this move of axis 0 takes 283 s or more, because Accel is only 1: units are counts and seconds
//@ says: at the end, after 1.000 s of board time:
//@ says:   thread 1 at acceleration_of_minutes.c:17:27 in `main` has waited since 0.000 s for the end of the motion of axis 0
//@ says:   axis 0: enabled, Dest 0.167, Position 0, moves at 0.5 units/s
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 600;
    ch0->Accel = 1;
    ch0->Jerk = 1;
    EnableAxisDest(0, 0);
    Move(0, 20000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
