//@ args: check
//@ says: warning[overflow]: 3000000000 does not fit in an `int`
//@ says: product_larger_than_an_int.c:8:21
#include "KMotionDef.h"

main()
{
    double counts = 60000 * 50000;
    printf("%f\n", counts);
}
