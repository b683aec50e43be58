//@ args: --machine parts/motor.toml --for 1
//@ prints: Following Error Disabled Axis:0
//@ says: thread 1 at axis_that_runs_away.c:14:5 in `main`: axis 0 runs away: its output drives it further from Dest; change the sign of OutputGain or of InputGain0
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->P = 1;
    ch0->OutputGain = -1;
    ch0->MaxFollowingError = 500;
    EnableAxisDest(0, 0);
    MoveAtVel(0, 5, 100);
    Delay_sec(0.5);
}
