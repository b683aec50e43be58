//@ prints: 8 8 1 2.500000
#include "KMotionDef.h"

_Static_assert(sizeof(long double) == 8, "long double");

struct { char c; long double d; } s; //~ redeclared
long double a = 1.25L;

main()
{
    s.d = 0.1L;
    a *= 2;
    printf("%d %d %d %f\n", sizeof a, (char *)&s.d - &s.c, s.d == 0.1, a);
}
//@ cycles: 11184
