//@ args: check
//@ says: warning[idle-loop]: `now - start < 5.0` is the same in every iteration: nothing in this loop changes `now` or `start`
//@ says: time_out_that_does_not_come.c:10:29
#include "KMotionDef.h"

main()
{
    double start, now;
    start = now = Time_sec();
    while (!ReadBit(136) && now - start < 5.0)
        WaitNextTimeSlice();
    if (!ReadBit(136)) printf("door is open\n");
}
