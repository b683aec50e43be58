#include "KMotionDef.h"

main()
{
    double start;
    Delay_sec(3);
    start = Time_sec();
    while (Time_sec() - start < 2.0) WaitNextTimeSlice();
    while (Time_sec() < 6.0) WaitNextTimeSlice();
}
