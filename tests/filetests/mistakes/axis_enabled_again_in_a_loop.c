//@ says: thread 1 at axis_enabled_again_in_a_loop.c:15:9 in `main`: EnableAxis: axis 0 has only just begun to move, and its motion ends here at once: wait with `while (!CheckDone(0));` first
#include "KMotionDef.h"

main()
{
    int i;
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    for (i = 0; i < 100; i++)
    {
        EnableAxis(0);
        if (CheckDone(0) == 1) Move(0, 5000);
        WaitNextTimeSlice();
    }
}
