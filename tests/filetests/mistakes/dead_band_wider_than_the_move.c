//@ args: --machine parts/ends.toml
//@ says: thread 1 at dead_band_wider_than_the_move.c:19:13 in `main`: CheckDone(0) is 1, but axis 0 is at 0 and its Dest is 400: CheckDone looks only at Dest, which the motor does not follow (its dead band, DeadBandRange = 500, covers the rest)
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->MaxOutput = 2000;
    ch0->MaxFollowingError = 1000;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    ch0->P = 1;
    ch0->DeadBandRange = 500;
    ch0->DeadBandGain = 0;
    EnableAxis(0);
    Move(0, 400);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
