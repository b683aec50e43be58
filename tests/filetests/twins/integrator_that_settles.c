//@ args: --machine ../mistakes/parts/heavy.toml
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->InputChan0 = 0;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->OutputChan0 = 0;
    ch0->P = 0.1;
    ch0->I = 0.0001;
    ch0->MaxI = 50;
    ch0->FFVel = 0.1;
    ch0->MaxOutput = 2047;
    ch0->MaxFollowingError = 1000;
    ch0->Vel = 2000;
    ch0->Accel = 10000;
    ch0->Jerk = 1e6;
    EnableAxis(0);
    Move(0, -3000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Delay_sec(3);
}
