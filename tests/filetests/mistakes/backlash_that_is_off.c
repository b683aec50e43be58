//@ prints: at 1000
//@ says: thread 1 at backlash_that_is_off.c:15:5 in `main`: Move: axis 0 has BacklashAmount = 25, but BacklashMode is BACKLASH_OFF, so nothing is taken up: set BACKLASH_LINEAR
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 5000;
    ch0->Accel = 50000;
    ch0->Jerk = 5e5;
    ch0->BacklashAmount = 25;
    ch0->BacklashRate = 2000;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    while (!CheckDone(0))
        WaitNextTimeSlice();
    printf("at %.0f\n", ch0->Dest);
}
