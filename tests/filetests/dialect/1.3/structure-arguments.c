//@ prints: 5 1
#include "KMotionDef.h"

struct Point { int x; double y; } p = { 1, 2.5 };

int change(struct Point q) { q.x += 4; return q.x; }

main()
{
    printf("%d ", change(p));
    printf("%d\n", p.x);
}
//@ cycles: 4970
