//@ args: check
//@ says: warning[float-equality]: `x` is a sum of rounded steps
//@ says: sum_of_tenths_compared_with_1.c:11:9
#include "KMotionDef.h"

main()
{
    double x = 0;
    int i;
    for (i = 0; i < 10; i++) x += 0.1;
    if (x == 1.0) printf("there\n");
}
