//@ args: check
//@ says: warning[float-counter]: `seconds`, a `float`, stops counting at 16777.216 or before
//@ says: float_that_counts_too_far.c:12:9
#include "KMotionDef.h"

main()
{
    float seconds = 0;
    for (;;)
    {
        Delay_sec(0.001);
        seconds += 0.001;
        *(float *)&persist.UserData[50] = seconds;
    }
}
