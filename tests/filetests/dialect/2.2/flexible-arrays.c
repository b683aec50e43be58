//@ prints: 7 8
#include "KMotionDef.h"

struct Flexible { int n; int list[]; };
struct Zero { int n; int list[0]; };

main()
{
    struct Flexible *f = (struct Flexible *)gather_buffer;
    struct Zero *z = (struct Zero *)gather_buffer;
    f->list[2] = 7;
    z->list[3] = 8;
    printf("%d %d\n", z->list[2], f->list[3]);
}
//@ cycles: 4557
