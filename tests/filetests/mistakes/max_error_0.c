//@ args: --machine parts/motor.toml
//@ says: thread 1 at max_error_0.c:17:5 in `main`: Move: axis 0 has MaxErr = 0, so its output stays 0 and its motor does not move
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
    ch0->MaxErr = 0;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
