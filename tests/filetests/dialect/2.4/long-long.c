//@ prints: 1000000000000 -3 -1 1
#include "KMotionDef.h"

long long big = 1000000;

main()
{
    long long product = big * big, minus = -7;
    unsigned long long wide = 1ull << 63;
    printf("%d%06d %d %d %d\n", (int)(product / 1000000), (int)(product % 1000000), (int)(minus / 2), (int)(minus % 2),
           wide > 1 && (double)wide == 9223372036854775808.0);
}
//@ cycles: 13649
