//@ args: check
//@ says: warning[absolute-time]: `Time_sec` is 3 or more here, so this loop never runs
//@ says: wait_until_a_time_that_has_passed.c:9:12
#include "KMotionDef.h"

main()
{
    Delay_sec(3);
    while (Time_sec() < 2.0) WaitNextTimeSlice();
}
