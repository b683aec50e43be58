//@ prints: 8 8 1
#include "KMotionDef.h"

_Static_assert(sizeof(long long) == 8 && sizeof(unsigned long long) == 8, "long long");

struct { char c; long long l; } s; //~ redeclared

main()
{
    printf("%d %d %d\n", sizeof(long long), (char *)&s.l - &s.c, 1ll << 40 > 0x7fffffff);
}
//@ cycles: 6623
