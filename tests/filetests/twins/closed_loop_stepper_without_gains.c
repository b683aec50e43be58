//@ args: --set axis.0.encoder=true
//@ prints: 5000
//@ prints: 0
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = CL_STEP_DIR_MODE;
    ch0->P = 0;
    ch0->I = 0;
    ch0->D = 0;
    ch0->FFVel = 0;
    ch0->FFAccel = 0;
    ch0->Vel = 5000;
    ch0->Accel = 50000;
    ch0->Jerk = 1e6;
    ch0->MaxFollowingError = 2000;
    EnableAxis(0);
    Move(0, 5000);
    while (!CheckDone(0)) ;
    Delay_sec(0.1);
    printf("%.0f\n", ch0->Position);
    ch0->P = 1;
    ch0->MaxErr = 0;
    ch0->MaxOutput = 0;
    Move(0, 0);
    while (!CheckDone(0)) ;
    Delay_sec(0.1);
    printf("%.0f\n", ch0->Position);
}
