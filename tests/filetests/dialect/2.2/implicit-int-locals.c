//@ prints: 1 2 3 4 5
#include "KMotionDef.h"

main()
{
    static a = 1;
    register b = 2;
    const c = 3;
    volatile d = 4;
    auto e = 5;
    printf("%d %d %d %d %d\n", a, b, c, d, e);
}
//@ cycles: 10763
