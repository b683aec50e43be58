#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->BacklashMode = BACKLASH_LINEAR;
    ch0->BacklashAmount = 12;
    ch0->BacklashRate = 1000;
    EnableAxisDest(0, 0);
    Move(0, 100);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
