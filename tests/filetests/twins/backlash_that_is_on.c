//@ prints: at 1000
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 5000;
    ch0->Accel = 50000;
    ch0->Jerk = 5e5;
    ch0->BacklashMode = BACKLASH_LINEAR;
    ch0->BacklashAmount = 25;
    ch0->BacklashRate = 2000;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    while (!CheckDone(0))
        WaitNextTimeSlice();
    printf("at %.0f\n", ch0->Dest);
}
