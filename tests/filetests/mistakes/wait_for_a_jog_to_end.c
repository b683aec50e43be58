//@ args: --for 0.5
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at wait_for_a_jog_to_end.c:17:9 in `main` has waited since 0.000 s for the end of the motion of axis 0
//@ says:   axis 0: enabled, Dest 48.806, Position 0, moves at 100 units/s
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, 100);
    while (!CheckDone(0))
        WaitNextTimeSlice();
}
