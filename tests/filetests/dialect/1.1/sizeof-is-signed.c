//@ prints: 1 -1
#include "KMotionDef.h"

_Static_assert(-1 < sizeof(int), "signed in constants");

int a[10];

main()
{
    int i = -1;
    size_t unsigned_size = 4;
    printf("%d %d\n", i < sizeof a, i < unsigned_size ? 1 : i); //~ negative-comparison
}
//@ cycles: 4711
