//@ args: check
//@ says: warning[copied-axis]: `ch0->Accel` is set among the settings of axis 1
//@ says: two_lines_of_a_copied_block.c:18:5
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1000000;
    EnableAxisDest(0, 0);
    ch1->InputMode = NO_INPUT_MODE;
    ch1->OutputMode = STEP_DIR_MODE;
    ch1->OutputChan0 = 9;
    ch1->Vel = 5000;
    ch0->Accel = 20000;
    ch0->Jerk = 200000;
    EnableAxisDest(1, 0);
}
