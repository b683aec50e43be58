//@ args: --set axis.0.max=5000
//@ says: thread 1 at stepper_beyond_the_end_of_its_travel.c:13:5 in `main`: axis 0 runs into the end of its travel at 5000 (--set axis.0.max): a stepper loses its steps there
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 8000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
