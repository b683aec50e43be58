//@ args: --machine parts/ends.toml
//@ prints: Following Error Disabled Axis:0
//@ says: thread 1 at integrator_that_swings.c:19:5 in `main`: axis 0 overshoots until its following error disables it: its integrator collects too much on the way, so lower I or MaxI, or raise D
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->MaxOutput = 2000;
    ch0->MaxFollowingError = 400;
    ch0->Vel = 4000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->P = 1;
    ch0->I = 0.05;
    ch0->MaxI = 2000;
    EnableAxis(0);
    Move(0, 20000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Delay_sec(0.5);
    Zero(0);
}
