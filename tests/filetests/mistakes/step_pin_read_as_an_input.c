//@ prints: home
//@ says: thread 1 at step_pin_read_as_an_input.c:14:9 in `main`: ReadBit(8): bit 8 is a step or direction output, not an input: check OutputChan0 of the axes
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Delay_sec(0.001);
    if (ReadBit(8)) printf("home\n");
}
