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
    Move(2, -5000);
    while (!CheckDone(2)) WaitNextTimeSlice();
    ch2->Vel = 2000;
    Move(2, -6000);
    while (!CheckDone(2)) WaitNextTimeSlice();
    MoveAtVel(2, 0, 4000);
    ch2->Vel = 8000;
    while (!CheckDone(2)) WaitNextTimeSlice();
}
