// The firmware's functions take no structures.
//@ exit: 1
//@ says: `struct Pair` is used where a number or pointer is needed
#include "KMotionDef.h"

struct Pair { int a, b; } pair;

main()
{
    printf("%d\n", pair);
}
