// No type is written that need not be.
//@ prints: 3 taps, 2 left, ratio 1
#include "KMotionDef.h"

count = 0; //~ implicit-int

tap(n)
//~^ old-style-definition
{
    static total;
    total += n;
    return total;
}

left(unsigned all, short used)
{
    register rest = all - used;
    return rest;
}

main()
{
    const limit = 5;
    for (count = 0; tap(1) < 3; count++) ;
    printf("%d taps, %d left, ratio %d\n", count + 1, left(limit, 3), limit / 3);
}
//@ cycles: 10032
