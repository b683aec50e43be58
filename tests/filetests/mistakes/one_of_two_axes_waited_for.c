//@ says: it goes to 0 from here and never arrives at 30000. Wait for it with `while (!CheckDone(1));`
//@ says: one_of_two_axes_waited_for.c:23:5
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch1->InputMode = NO_INPUT_MODE;
    ch1->OutputMode = STEP_DIR_MODE;
    ch1->OutputChan0 = 1;
    ch1->Vel = 10000;
    ch1->Accel = 100000;
    ch1->Jerk = 1e6;
    EnableAxisDest(0, 0);
    EnableAxisDest(1, 0);
    Move(0, 1000);
    Move(1, 30000);
    while (!CheckDone(0)) ;
    Move(1, 0);
    while (!CheckDone(1)) ;
}
