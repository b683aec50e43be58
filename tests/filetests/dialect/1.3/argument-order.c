//@ prints: 1 2 3
//@ prints: 4 5 6 7
#include "KMotionDef.h"

int n;
next() { return ++n; }
show(int a, int b, int c, int d) { printf("%d %d %d %d\n", a, b, c, d); }

main()
{
    printf("%d %d %d\n", next(), next(), next());
    show(next(), next(), next(), next());
}
//@ cycles: 15334
