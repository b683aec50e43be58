// Set-up as the configuration screen writes it: one line for each parameter.
//@ prints: axis 0: 40000 units/s, gain 10, limits 1e+09
//@ prints: axis 1: same speed
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = NO_OUTPUT_MODE;
    ch0->Vel = 40000;
    ch0->Accel = 400000;
    ch0->Jerk = 4e+06;
    ch0->P = 10;
    ch0->I = 0.01;
    ch0->D = 0;
    ch0->MaxFollowingError = 1000000000;
    ch0->invDistPerCycle = 1;
    ch0->MaxI = 200;
    ch0->SoftLimitPos = 1e+09;
    ch0->SoftLimitNeg = -1e+09;
    ch0->iir[0].B0 = 1;
    ch0->iir[0].A1 = 0;

    ch1->Vel = ch0->Vel;

    printf("axis 0: %g units/s, gain %g, limits %g\n", ch0->Vel, ch0->P, chan[0].SoftLimitPos);
    if (chan[1].Vel == ch0->Vel) printf("axis 1: same speed\n");
}
//@ cycles: 30673
