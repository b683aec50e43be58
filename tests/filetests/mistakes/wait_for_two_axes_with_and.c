//@ args: check
//@ says: warning[wait-for-any]: this loop ends when the first axis has arrived
//@ says: wait_for_two_axes_with_and.c:10:12
#include "KMotionDef.h"

main()
{
    MoveRel(0, 3000);
    MoveRel(1, 5000);
    while (!CheckDone(0) && !CheckDone(1))
        WaitNextTimeSlice();
}
