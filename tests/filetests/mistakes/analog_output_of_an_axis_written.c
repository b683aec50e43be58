//@ says: a program writes DAC 0, which axis 0 drives too: the axis overwrites it in each tick. Use another output, or disable the axis
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->P = 1;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxis(0);
    Delay_sec(0.1);
    DAC(0, 500);
    Delay_sec(0.1);
}
