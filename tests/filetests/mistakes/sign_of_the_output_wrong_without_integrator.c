//@ args: --machine parts/heavy.toml
//@ prints: Following Error Disabled Axis:0
//@ says: thread 1 at sign_of_the_output_wrong_without_integrator.c:19:5 in `main`: axis 0 runs away: its output drives it further from Dest; change the sign of OutputGain or of InputGain0
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->OutputChan0 = 0;
    ch0->P = 0.3;
    ch0->MaxOutput = 2047;
    ch0->Vel = 10000;
    ch0->Accel = 30000;
    ch0->Jerk = 1e6;
    ch0->OutputGain = -1;
    ch0->MaxFollowingError = 2000;
    EnableAxis(0);
    Move(0, -3000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Delay_sec(3);
}
