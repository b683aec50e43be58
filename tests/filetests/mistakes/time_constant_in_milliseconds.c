//@ args: --for 1
//@ says: thread 1 at time_constant_in_milliseconds.c:13:5 in `main`: MoveExp: axis 0 approaches its target with a time constant of 50 s, so it takes 50 s for two thirds of the way: Tau is in seconds
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    MoveExp(0, 5000, 50);
    Delay_sec(0.5);
}
