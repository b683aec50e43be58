//@ args: --machine parts/slow_motor.toml --set axis.0.max=2000
//@ says: thread 1 at motor_against_the_end_of_its_travel.c:17:5 in `main`: axis 0 runs into the end of its travel at 2000 (--set axis.0.max): its motor pushes against the stop
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->OutputChan0 = 0;
    ch0->P = 0.3;
    ch0->MaxOutput = 2047;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->MaxFollowingError = 1e9;
    EnableAxis(0);
    Move(0, 8000);
    Delay_sec(2);
}
