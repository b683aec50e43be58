//@ args: --machine parts/slow_motor.toml
//@ says: thread 1 at pwm_without_an_amplifier.c:10:5 in `main`: EnableAxis: axis 0 drives PWM channel 0, where a KFLOP has no amplifier: a SnapAmp has channels 8 to 15, and an amplifier with an analog input needs DAC_SERVO_MODE
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DC_SERVO_MODE;
    ch0->OutputChan0 = 0;
    EnableAxis(0);
}
