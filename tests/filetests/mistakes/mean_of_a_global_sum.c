//@ args: check
//@ says: warning[stale-sum]: `total` still has its last sum when it is added up for this mean
//@ says: mean_of_a_global_sum.c:16:12
#include "KMotionDef.h"

double total = 0;

double measure(int channel)
{
    int i;
    for (i = 0; i < 20; i++)
    {
        total += ADC(channel);
        WaitNextTimeSlice();
    }
    return total / 20.0;
}

main()
{
    double first = measure(0), second = measure(1);
    printf("%f %f\n", first, second);
}
