//@ says: thread 1 at zeroed_before_it_has_stopped.c:15:5 in `main`: Zero: axis 0 still moves at 1000 units/s, and its motion ends here at once: wait with `while (!CheckDone(0));` first
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, -1000);
    Delay_sec(0.5);
    Jog(0, 0);
    Zero(0);
}
