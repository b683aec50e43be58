//@ prints: 4294967295 3 4294967293 1 3000000000
//@ prints: 4294967295 3 4294967293 1 3000000000
#include "KMotionDef.h"

double large = 4294967295.0, small = 3.99, minus = -3.99, beyond = 4294967297.0;
float f = 3e9f;
static unsigned a = (unsigned)4294967295.0, b = (unsigned)3.99, c = (unsigned)-3.99, d = (unsigned)4294967297.0;
static unsigned e = 3e9f;

main()
{
    printf("%u %u %u %u %u\n", (unsigned)large, (unsigned)small, (unsigned)minus, (unsigned)beyond, (unsigned)f);
    printf("%u %u %u %u %u\n", a, b, c, d, e);
}
//@ cycles: 36593
