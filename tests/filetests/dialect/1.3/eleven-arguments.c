//@ prints: 78 12
#include "KMotionDef.h"

int sum(int a, int b, int c, int d, int e, int f, int g, int h, int i, int j, int k, double l)  //~ vendor-parameter
{
    return a + b + c + d + e + f + g + h + i + j + k + (int)l;
}

twelve(a, b, c, d, e, f, g, h, i, j, k, l) { return l; } //~ old-style-definition
    //~^ vendor-parameter

main()
{
    printf("%d %d\n", sum(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12.0), twelve(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
}
//@ cycles: 5109
