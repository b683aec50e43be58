//@ args: --machine parts/ends.toml
//@ prints: Following Error Disabled Axis:0
//@ says: axis 0 does not follow: its output has changed from end to end
//@ says: derivative_gain_far_too_high.c:19:5
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->MaxOutput = 2000;
    ch0->MaxFollowingError = 1000;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->P = 1;
    ch0->D = 2000;
    EnableAxis(0);
    Move(0, 4000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Delay_sec(0.5);
    Zero(0);
}
