//@ args: --machine parts/ends.toml
//@ prints: there
//@ says: thread 1 at gain_far_too_low.c:17:13 in `main`: CheckDone(0) is 1, but axis 0 is at 0 and its Dest is 1000: CheckDone looks only at Dest, which the motor does not follow (check P, OutputMode and the wiring)
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->MaxOutput = 2000;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->P = 0.001;
    EnableAxis(0);
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf("there\n");
}
