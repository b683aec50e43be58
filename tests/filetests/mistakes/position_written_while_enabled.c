//@ args: --machine parts/motor.toml
//@ says: thread 1 at position_written_while_enabled.c:21:5 in `main`: Position of axis 0 is changed from 1999 to 0 while the axis is enabled, so its motor leaps: disable it first, or use Zero(0) (noticed at this call)
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
    Move(0, 2000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Delay_sec(0.3);
    ch0->Position = 0;
    Delay_sec(0.5);
}
