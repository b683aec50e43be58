//@ exit: 1
//@ says: enum
#include "KMotionDef.h"

const int N = 5;
int a[N]; //~ error: constant

void f(int n)
{
    int list[n]; //~ error: constant
    list[0] = n;
}

main() { f(3); }
