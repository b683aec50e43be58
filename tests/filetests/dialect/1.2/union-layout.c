//@ prints: 16 8 2.000000
#include "KMotionDef.h"

union U { char c; double d; int i[3]; };
struct S { char c; union U u; };
_Static_assert(sizeof(union U) == 16 && _Alignof(union U) == 8 && sizeof(struct S) == 24, "union");

union U u;
struct S s; //~ redeclared

main()
{
    u.i[0] = 0;
    u.i[1] = 0x40000000;
    printf("%d %d %f\n", sizeof u, (char *)&s.u - &s.c, u.d);
}
//@ cycles: 9385
