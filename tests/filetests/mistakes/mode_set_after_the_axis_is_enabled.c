//@ says: thread 1 at mode_set_after_the_axis_is_enabled.c:12:5 in `main`: Move: OutputMode of axis 0 has changed since the axis was enabled: set it before EnableAxis, which prepares the output and takes over the position
#include "KMotionDef.h"

main()
{
    EnableAxis(0);
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    Move(0, 1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
