//@ prints: 4 4 4 4 7
#include "KMotionDef.h"

_Static_assert(sizeof(int) == 4 && sizeof(long) == 4 && _Alignof(long) == 4, "32 bits");

long a = 7;
int *p = &a; // a pointer to `long` is a pointer to `int`
unsigned b;
unsigned long c;
extern long d;
int d = 7;

main()
{
    printf("%d %d %d %d %d\n", sizeof a, sizeof d, sizeof b, sizeof c, *p);
}
//@ cycles: 10759
