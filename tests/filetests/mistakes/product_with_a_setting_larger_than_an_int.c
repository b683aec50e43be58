//@ args: check
//@ says: warning[overflow]: 2700000000 does not fit in an `int`
//@ says: product_with_a_setting_larger_than_an_int.c:10:20
#include "KMotionDef.h"

int Minutes = 45;

main()
{
    int interval = Minutes * 60 * 1000000;
    double end = Time_sec() + interval * 1e-6;

    while (Time_sec() < end) WaitNextTimeSlice();
    SetBit(47);
}
