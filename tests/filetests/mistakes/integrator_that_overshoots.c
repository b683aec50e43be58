//@ args: --machine parts/heavy.toml
//@ prints: Following Error Disabled Axis:0
//@ says: thread 1 at integrator_that_overshoots.c:21:5 in `main`: axis 0 overshoots until its following error disables it: its integrator collects too much on the way, so lower I or MaxI, or raise D
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->OutputChan0 = 0;
    ch0->P = 0.3;
    ch0->I = 0.001;
    ch0->MaxI = 500;
    ch0->FFVel = 0.1;
    ch0->MaxOutput = 2047;
    ch0->Vel = 10000;
    ch0->Accel = 30000;
    ch0->Jerk = 1e6;
    ch0->MaxFollowingError = 800;
    EnableAxis(0);
    Move(0, -3000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Delay_sec(3);
}
