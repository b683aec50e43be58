//@ prints: 1.500000 3fc00000 9
#include "KMotionDef.h"

struct Value { union { float f; int bits; }; struct { int n; }; } v;

main()
{
    v.f = 1.5f;
    v.n = 9;
    printf("%f %x %d\n", v.f, v.bits, v.n);
}
//@ cycles: 10772
