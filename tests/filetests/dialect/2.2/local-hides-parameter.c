//@ prints: 7
#include "KMotionDef.h"

f(int n)
{
    int n = 7; //~ redeclared: n
    return n;
}

main() { printf("%d\n", f(3)); }
//@ cycles: 2481
