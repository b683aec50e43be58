// The drill moves when both axes have arrived; an axis that jogs goes on, and one that is waited for later may still move.
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
    Setup(3, 5000);
    Jog(3, 1000);
    Move(0, 1000);
    Move(1, 5000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    while (!CheckDone(1)) WaitNextTimeSlice();
    Move(2, -2000);
    while (!CheckDone(2)) WaitNextTimeSlice();
    Move(1, 0);
    Move(2, 0);
    while (!CheckDone(2)) WaitNextTimeSlice();
    Move(0, 0);
    while (!CheckDone(0) || !CheckDone(1)) WaitNextTimeSlice();
    DisableAxis(3);
}
