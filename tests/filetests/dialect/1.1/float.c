//@ prints: 4 3f800000 bf000000 7f800000
#include "KMotionDef.h"

_Static_assert(sizeof(float) == 4 && _Alignof(float) == 4, "float");

float a = 1, b = -0.5f, zero = 0;

main()
{
    float infinite = 1 / zero;
    printf("%d %x %x %x\n", sizeof a, *(int *)&a, *(int *)&b, *(int *)&infinite);
}
//@ cycles: 13798
