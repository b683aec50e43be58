//@ args: --set axis.0.encoder=true --set axis.0.counts_per_unit=4
//@ prints: Following Error Disabled Axis:0
//@ says: thread 1 at encoder_with_4_counts_for_a_unit.c:19:5 in `main`: axis 0: its Position moves 4.00 times as far as its Dest: InputGain0 = 1 does not fit the counts of the encoder, 0.250 does
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = CL_STEP_DIR_MODE;
    ch0->InputGain0 = 1;
    ch0->P = 0.001;
    ch0->MaxErr = 500;
    ch0->MaxOutput = 50000;
    ch0->MaxFollowingError = 2000;
    ch0->Vel = 5000;
    ch0->Accel = 50000;
    ch0->Jerk = 1e6;
    EnableAxis(0);
    Move(0, 5000);
    while (!CheckDone(0)) ;
}
