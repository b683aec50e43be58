//@ says: thread 1 at pwm_channel_of_an_axis_written.c:11:5 in `main`: WritePWMC(8, …): axis 0 drives this channel and overwrites it in each tick: disable the axis first
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DC_SERVO_MODE;
    ch0->OutputChan0 = 8;
    ch0->P = 1;
    EnableAxis(0);
    WritePWMC(8, 100);
}
