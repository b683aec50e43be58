//@ args: check
#include "KMotionDef.h"

main()
{
    double start, now;
    start = now = Time_sec();
    while (!ReadBit(136) && now - start < 5.0)
    {
        WaitNextTimeSlice();
        now = Time_sec();
    }
    while (!ReadBit(137) && Time_sec() - start < 10.0)
        WaitNextTimeSlice();
}
