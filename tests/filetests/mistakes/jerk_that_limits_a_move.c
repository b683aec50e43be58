//@ prints: moves
//@ says: Move: this move of axis 0 takes 7 s or more, because Jerk is only 1000
//@ says: jerk_that_limits_a_move.c:16:5
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 20000;
    ch0->Accel = 200000;
    ch0->Jerk = 1000;
    EnableAxisDest(0, 0);
    printf("moves\n");
    Move(0, 10000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
