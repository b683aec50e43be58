//@ args: --machine parts/heavy.toml
//@ prints: Following Error Disabled Axis:0
//@ says: thread 1 at gain_too_low_to_move.c:17:5 in `main`: axis 0 has not moved since it was enabled: its output has only come to 0.5 of 2000 (MaxOutput), which is too little to move its motor: raise P (now 0.001) or FFVel
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->MaxOutput = 2000;
    ch0->MaxFollowingError = 500;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->P = 0.001;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
