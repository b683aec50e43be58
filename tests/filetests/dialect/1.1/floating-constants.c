//@ prints: 8 4 0 1
#include "KMotionDef.h"

_Static_assert(sizeof 1.5 == 8 && sizeof 1.5f == 4 && sizeof 1e3F == 4, "no demotion");

main()
{
    printf("%d %d %d %d\n", sizeof 1.5, sizeof 1.5f, 0.1f == 0.1, 0.5f == 0.5);
}
//@ cycles: 8690
