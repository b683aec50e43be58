//@ prints: 7 2.500000 9
#include "KMotionDef.h"

add(a, b) { return a + b; } //~ old-style-definition
double half(x) double x; { return x / 2; } //~ old-style-definition
pick(list, n) //~ old-style-definition
    int *list;
{
    return list[n];
}

main()
{
    int list[] = { 8, 9 };
    printf("%d %f %d\n", add(3, 4), half(5.0), pick(list, 1));
}
//@ cycles: 9105
