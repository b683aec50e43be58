//@ says: thread 1 at axis_disabled_after_a_delay_that_is_too_short.c:14:5 in `main`: DisableAxis: axis 0 is at 21 on its way to 1000, and its motion ends here at once: wait with `while (!CheckDone(0));` first
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Move(0, 1000);
    Delay_sec(0.05);
    DisableAxis(0);
}
