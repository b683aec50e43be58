//@ args: --machine parts/motor.toml
//@ says: thread 1 at microstepping_without_an_amplifier.c:16:5 in `main`: EnableAxisDest: axis 0 drives PWM channel 0, where a KFLOP has no amplifier
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = MICROSTEP_MODE;
    ch0->OutputChan0 = 0;
    ch0->OutputChan1 = 1;
    ch0->StepperAmplitude = 100;
    ch0->invDistPerCycle = 0.25;
    ch0->Vel = 1000;
    ch0->Accel = 10000;
    ch0->Jerk = 1e5;
    EnableAxisDest(0, 0);
}
