//@ says: CheckDone(0): Vel of axis 0 was changed from 8000 to 2000 during its move
//@ says: speed_as_an_override_during_a_move.c:14:13
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 8000;
    ch0->Accel = 80000;
    ch0->Jerk = 800000;
    EnableAxisDest(0, 0);
    Move(0, 8000);
    while (!CheckDone(0))
    {
        ch0->Vel = Time_sec() < 0.5 ? 2000 : 8000;
        WaitNextTimeSlice();
    }
}
