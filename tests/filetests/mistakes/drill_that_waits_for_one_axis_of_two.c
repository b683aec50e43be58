//@ says: Move: axis 2 begins to move while axis 1 is still on its way, and no program ever waits for that one
//@ says: drill_that_waits_for_one_axis_of_two.c:25:5
#include "KMotionDef.h"

void Setup(int axis, float speed)
{
    CHAN *ch = &chan[axis];
    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = STEP_DIR_MODE;
    ch->OutputChan0 = axis;
    ch->Vel = speed;
    ch->Accel = 10 * speed;
    ch->Jerk = 100 * speed;
    EnableAxisDest(axis, 0);
}

main()
{
    Setup(0, 10000);
    Setup(1, 5000);
    Setup(2, 5000);
    Move(0, 1000);
    Move(1, 5000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Move(2, -2000);
    while (!CheckDone(2)) WaitNextTimeSlice();
}
