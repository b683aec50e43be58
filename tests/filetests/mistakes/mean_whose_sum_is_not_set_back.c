//@ args: check
//@ says: warning[stale-sum]: `sum` still has its last sum when it is added up for this mean
//@ says: mean_whose_sum_is_not_set_back.c:20:29
#include "KMotionDef.h"

#define N 10

main()
{
    int i, round;
    double sum = 0;

    for (round = 0; round < 3; round++)
    {
        for (i = 0; i < N; i++)
        {
            sum = sum + ADC(0);
            WaitNextTimeSlice();
        }
        printf("mean %f\n", sum / N);
    }
}
