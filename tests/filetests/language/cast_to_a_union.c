// The GNU cast to a union: the value goes to the member of its type.
//@ prints: 1065353216 7
#include "KMotionDef.h"

union number { float f; int i; };
int bits(union number n) { return n.i; }

main()
{
    printf("%d %d\n", bits((union number)1.0f), bits((union number)7));
}
//@ cycles: 7080
