//@ args: check
//@ says: warning[copied-axis]: `ch0->Vel` is set among the settings of axis 1
//@ says: copied_block_that_still_names_the_old_axis.c:19:5
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);

    ch1->InputMode = NO_INPUT_MODE;
    ch1->OutputMode = STEP_DIR_MODE;
    ch1->OutputChan0 = 9;
    ch0->Vel = 20000;
    ch1->Accel = 100000;
    ch1->Jerk = 1e6;
    EnableAxisDest(1, 0);
}
