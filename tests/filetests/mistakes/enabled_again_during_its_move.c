//@ says: thread 1 at enabled_again_during_its_move.c:14:5 in `main`: EnableAxisDest: axis 0 still moves at 1245 units/s, and its motion ends here at once: wait with `while (!CheckDone(0));` first
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
    Delay_sec(0.05);
    EnableAxisDest(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
