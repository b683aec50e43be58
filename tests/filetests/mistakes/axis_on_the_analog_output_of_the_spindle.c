//@ args: --machine parts/spindle_on_dac.toml
//@ says: thread 1 at axis_on_the_analog_output_of_the_spindle.c:16:5 in `main`: EnableAxis: axis 0 drives DAC 0, which the spindle is connected to: give the axis an OutputChan0 of its own
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
    ch0->MaxFollowingError = 1000;
    EnableAxis(0);
}
