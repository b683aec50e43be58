//@ args: --machine parts/wired.toml
//@ says: thread 1 at motor_on_another_dac.c:16:5 in `main`: EnableAxis: axis 0 drives DAC 6 (OutputMode, OutputChan0), but its motor is connected to DAC 0
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->OutputChan0 = 6;
    ch0->P = 0.3;
    ch0->MaxOutput = 2047;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->MaxFollowingError = 1000;
    EnableAxis(0);
    MoveAtVel(0, 1000, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
