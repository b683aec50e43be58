//@ says: thread 1 at inches_instead_of_counts.c:12:5 in `main`: Move: axis 0 moves by 2.5 units, and never further: units are counts of an encoder or steps
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 2.5);
    while (!CheckDone(0)) WaitNextTimeSlice();
    MoveRel(0, -0.75);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
