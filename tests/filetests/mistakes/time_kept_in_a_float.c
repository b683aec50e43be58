//@ args: check
//@ says: warning[float-time]: a `float` cannot hold the value of `Time_sec`
//@ says: time_kept_in_a_float.c:8:19
#include "KMotionDef.h"

main()
{
    float start = Time_sec();
    while (Time_sec() - start < 2) WaitNextTimeSlice();
}
