//@ prints: 1 1 1
#include "KMotionDef.h"

double small = 1e-310;
float single = 1e-40f;

main()
{
    printf("%d %d %d\n", small > 0, single > 0, small / 2 < small);
}
//@ processor: denormal numbers count as zero
//@ cycles: 6634
