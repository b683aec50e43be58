//@ prints: 3e+09 2147483646
#include "KMotionDef.h"

main()
{
    double counts = 60000.0 * 50000;
    int mask = 0x7fffffff;
    printf("%g %d\n", counts, mask + -1);
}
