//@ args: check
//@ says: warning[float-time]: `start` holds whole seconds: the fraction of `Time_sec` is lost
//@ says: time_kept_in_an_int.c:8:17
#include "KMotionDef.h"

main()
{
    int start = Time_sec();
    while (Time_sec() - start < 0.5) WaitNextTimeSlice();
}
