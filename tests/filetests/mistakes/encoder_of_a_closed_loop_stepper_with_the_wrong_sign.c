//@ args: --set axis.0.encoder=true
//@ prints: Following Error Disabled Axis:0
//@ says: thread 1 at encoder_of_a_closed_loop_stepper_with_the_wrong_sign.c:17:5 in `main`: axis 0 runs away: its output drives it further from Dest; change the sign of OutputGain or of InputGain0
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = CL_STEP_DIR_MODE;
    ch0->InputGain0 = -1;
    ch0->P = 0.001;
    ch0->MaxFollowingError = 1000;
    ch0->Vel = 5000;
    ch0->Accel = 50000;
    ch0->Jerk = 1e6;
    EnableAxis(0);
    Move(0, 5000);
    while (!CheckDone(0)) ;
}
