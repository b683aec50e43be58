// The type of `?:` on pointers: the qualifiers of both, `void` over any, the array whose length is known.
//@ prints: 1 2 3 4
#include "KMotionDef.h"

int n = 1;
#define KIND(p) _Generic(p, int *: 0, volatile const int *: 1, volatile const void *: 2, int (*)[4]: 3, char *: 4)

main()
{
    printf("%d %d %d %d\n",
        KIND(n ? (volatile int *)0 : (const int *)0),
        KIND(n ? (volatile int *)0 : (const void *)8),
        KIND(n ? (int (*)[])0 : (int (*)[4])0),
        KIND(n ? (char *)0 : (void *)0));
}
//@ cycles: 8691
