//@ args: check
//@ snapshot
#include "KMotionDef.h"

int count;
double speed;

void report(int *value, double *rate)
{
    printf("%d parts, %f a second\n", value, rate);
}

main()
{
    report(&count, &speed);
}
