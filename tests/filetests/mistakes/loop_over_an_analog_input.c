//@ args: --machine parts/slow_motor.toml
//@ says: thread 1 at loop_over_an_analog_input.c:16:5 in `main`: EnableAxis: axis 0 closes its loop over analog input 0, which nothing drives: ENCODER_MODE reads the encoder of a motor
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ADC_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->OutputChan0 = 0;
    ch0->P = 0.3;
    ch0->MaxOutput = 2047;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->MaxFollowingError = 1000;
    EnableAxis(0);
}
