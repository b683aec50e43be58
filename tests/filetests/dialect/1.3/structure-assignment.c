//@ prints: 1 2.500000 9 1
#include "KMotionDef.h"

struct Point { int x; double y; };

main()
{
    struct Point a = { 1, 2.5 }, b, c = a;
    b = a;
    a.x = 9;
    printf("%d %f %d %d\n", b.x, b.y, a.x, c.x);
}
//@ cycles: 11204
