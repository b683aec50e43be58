//@ args: --for 0.5
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at wait_for_the_motion_of_a_disabled_axis.c:9:9 in `main` has waited since 0.000 s for axis 1, which is disabled: CheckDone(1) is -1
#include "KMotionDef.h"

main()
{
    while (CheckDone(1) != 1)
        WaitNextTimeSlice();
}
