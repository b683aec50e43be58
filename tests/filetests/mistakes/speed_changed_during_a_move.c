//@ says: CheckDone(2): Vel of axis 2 was changed from 8000 to 500 during its move, which kept the Vel that it began with
//@ says: speed_changed_during_a_move.c:19:
#include "KMotionDef.h"

main()
{
    ch2->InputMode = NO_INPUT_MODE;
    ch2->OutputMode = STEP_DIR_MODE;
    ch2->OutputChan0 = 2;
    ch2->Vel = 8000;
    ch2->Accel = 80000;
    ch2->Jerk = 800000;
    EnableAxisDest(2, 0);
    Move(2, -6000);
    while (ch2->Dest > -5000)
        WaitNextTimeSlice();
    // The last part is to be slow.
    ch2->Vel = 500;
    while (!CheckDone(2)) WaitNextTimeSlice();
}
