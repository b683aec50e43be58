//@ args: --machine parts/home.toml
//@ says: thread 1 at step_output_on_the_pin_of_a_switch.c:13:5 in `main`: axis 2 steps on OutputChan0 = 2, which uses bit 12, an input driven by the machine: set OutputChan0 to a free generator
#include "KMotionDef.h"

main()
{
    ch2->InputMode = NO_INPUT_MODE;
    ch2->OutputMode = STEP_DIR_MODE;
    ch2->Vel = 10000;
    ch2->Accel = 100000;
    ch2->Jerk = 1e6;
    ch2->OutputChan0 = 2;
    EnableAxisDest(2, 0);
}
