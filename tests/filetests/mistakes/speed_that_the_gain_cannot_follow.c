//@ args: --machine parts/ends.toml
//@ prints: Following Error Disabled Axis:0
//@ says: thread 1 at speed_that_the_gain_cannot_follow.c:17:5 in `main`: axis 0 falls behind its Dest by more than MaxFollowingError = 200, in the right direction: raise P or FFVel, or lower Vel or Accel, or allow more with MaxFollowingError
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->MaxOutput = 2000;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->P = 1;
    ch0->MaxFollowingError = 200;
    EnableAxis(0);
    Move(0, 2000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
