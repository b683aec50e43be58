//@ exit: 1
#include "KMotionDef.h"

struct A { int a; } a;
struct B { int b; } b;

main()
{
    int *p = 0, **q;
    struct A *r;
    q = p; //~ pointer-mismatch
    r = &b; //~ error: cannot convert
    r = &a;
}
