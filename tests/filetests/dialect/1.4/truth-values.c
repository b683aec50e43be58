//@ prints: 1 0 1 0 1 0
//@ prints: 1 0 1 0 1 0
//@ prints: 1 1 0 1
#include "KMotionDef.h"

int a = 5, b = 7;
static int c1 = 5 <= 7, c2 = 5 >= 7, c3 = 5 != 7, c4 = !5, c5 = 5 && 7, c6 = 0 || 0;  //~ logical-constant

main()
{
    printf("%d %d %d %d %d %d\n", a <= b, a >= b, a != b, !a, a && b, 0 || a - 5);
    printf("%d %d %d %d %d %d\n", c1, c2, c3, c4, c5, c6);
    printf("%d %d %d %d\n", (a < b) + (a > b), !!b, 1.5 > 2.5, 1.5 <= 2.5);
}
//@ cycles: 34364
