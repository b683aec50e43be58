//@ prints: 4 8 4 8
#include "KMotionDef.h"

struct F { int n; char rest[]; };
struct Z { double d; int rest[0]; };
_Static_assert(sizeof(struct F) == 4 && sizeof(struct Z) == 8, "no room");

main()
{
    struct F *f = (struct F *)gather_buffer;
    struct Z *z = (struct Z *)gather_buffer;
    printf("%d %d %d %d\n", sizeof *f, sizeof *z, (char *)f->rest - (char *)f, (char *)z->rest - (char *)z);
}
//@ cycles: 8695
