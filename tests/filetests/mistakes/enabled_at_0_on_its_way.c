//@ says: Move: axis 0 was disabled on its way, at 
//@ says: and enabled with Dest = 0 by thread 1 at enabled_at_0_on_its_way.c:18:5
//@ says: enabled_at_0_on_its_way.c:19:5
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 30000);
    while (!CheckDone(0) && ch0->Dest < 10000) WaitNextTimeSlice();
    DisableAxis(0);
    EnableAxisDest(0, 0);
    Move(0, 30000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
