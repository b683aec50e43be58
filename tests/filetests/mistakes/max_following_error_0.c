//@ prints: Following Error Disabled Axis:0
//@ says: thread 1 at max_following_error_0.c:15:5 in `main`: Move: axis 0 has MaxFollowingError = 0, so the least error while it moves disables it
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->P = 1;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->MaxFollowingError = 0;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
