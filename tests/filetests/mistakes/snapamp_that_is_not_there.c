//@ args: --machine parts/motor.toml
//@ says: thread 1 at snapamp_that_is_not_there.c:10:5 in `main`: EnableAxis: axis 0 drives PWM channel 8, which belongs to a SnapAmp, and the machine has none
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DC_SERVO_MODE;
    ch0->OutputChan0 = 8;
    EnableAxis(0);
}
