//@ prints: 3 4.500000 3
#include "KMotionDef.h"

struct Point { int x; double y; };

struct Point point(int x, double y) { struct Point p; p.x = x; p.y = y; return p; }

main()
{
    struct Point p;
    p = point(3, 4.5);
    printf("%d %f %d\n", p.x, p.y, point(3, 0).x);
}
//@ cycles: 9188
