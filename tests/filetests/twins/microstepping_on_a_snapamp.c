//@ args: --machine ../mistakes/parts/motor.toml --set board.snapamp=1
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = MICROSTEP_MODE;
    ch0->OutputChan0 = 8;
    ch0->OutputChan1 = 9;
    ch0->StepperAmplitude = 100;
    ch0->invDistPerCycle = 0.25;
    ch0->Vel = 1000;
    ch0->Accel = 10000;
    ch0->Jerk = 1e5;
    EnableAxisDest(0, 0);
}
