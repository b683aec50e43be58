//@ args: --machine ../mistakes/parts/motor.toml
//@ prints: 2000
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->InputChan0 = 0;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->OutputChan0 = 0;
    ch0->P = 0.3;
    ch0->MaxOutput = 2047;
    ch0->MaxFollowingError = 1000;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    Delay_sec(0.1);
    ch0->Position = 2000;
    EnableAxis(0);
    Delay_sec(0.2);
    printf("%.0f\n", ch0->Position);
}
