//@ prints: 5 of 7, 0.500000
#include "KMotionDef.h"

main()
{
    long count = 5;
    printf("%d of %d, %lf\n", count, 7, 0.5);
}
