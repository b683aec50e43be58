//@ prints: 0 1 0 0 1
#include "KMotionDef.h"

double d = 1.5, zero = 0;
float small = 1e-30f;
static int folded = !1.5;
enum { NOT = !0.0 };

main()
{
    printf("%d %d %d %d %d\n", !d, !zero, !small, folded, NOT);
}
//@ cycles: 10768
