//@ says: thread 1 at slave_not_enabled.c:13:5 in `main`: axis 1 has MasterAxis = 0, but is disabled, so it does not follow: call EnableAxis(1)
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch1->MasterAxis = 0;
    EnableAxisDest(0, 0);
    Move(0, 100);
    while (!CheckDone(0)) ;
}
