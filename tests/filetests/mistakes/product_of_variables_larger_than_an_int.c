//@ args: check
//@ says: warning[overflow]: 4500000000 does not fit in an `int`
//@ says: product_of_variables_larger_than_an_int.c:9:20
#include "KMotionDef.h"

main()
{
    int counts = 50000;
    printf("%d\n", counts * 90000);
}
