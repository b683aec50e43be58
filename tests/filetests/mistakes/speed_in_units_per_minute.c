//@ args: --for 1
//@ says: thread 1 at speed_in_units_per_minute.c:13:5 in `main`: Move: this move of axis 0 takes 10000 s or more, because Vel is only 0.5: units are counts and seconds
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 0.5;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 5000);
    Delay_sec(0.5);
}
