//@ prints: 5 7
#include "KMotionDef.h"

const int limit = 3;
const double factor = 1.5;

main()
{
    int *p = (int *)&limit;
    *p = 5;
    printf("%d ", limit);
    limit = 7; //~ const-write
    printf("%d\n", limit);
}
//@ cycles: 4961
