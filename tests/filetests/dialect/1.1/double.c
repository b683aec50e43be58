//@ prints: 8 8 0 3ff00000
#include "KMotionDef.h"

_Static_assert(sizeof(double) == 8 && _Alignof(double) == 8, "double");

struct { char c; double d; } s = { 0, 1.0 }; //~ redeclared

main()
{
    int *halves = (int *)&s.d;
    printf("%d %d %x %x\n", sizeof s.d, (char *)&s.d - &s.c, halves[0], halves[1]);
}
//@ cycles: 10370
