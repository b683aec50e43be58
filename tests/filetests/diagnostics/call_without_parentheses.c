//@ args: check
//@ snapshot
#include "KMotionDef.h"

main()
{
    double start = Time_sec();

    while (Time_sec() < start + 1.0) WaitNextTimeSlice;
}
