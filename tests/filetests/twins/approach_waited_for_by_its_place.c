#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    MoveExp(0, 1000, 0.01);
    while (ch0->Dest < 999.9) WaitNextTimeSlice();
    DisableAxis(0);
}
