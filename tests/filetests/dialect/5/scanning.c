//@ prints: 3 1.5 -2.0 1000.0
//@ prints: 1 42
//@ prints: 0
#include "KMotionDef.h"

main()
{
    double x, y, z;
    int n, count;
    count = sscanf("1.5,-2,1e3", "%lf,%lf,%lf", &x, &y, &z);
    printf("%d %.1f %.1f %.1f\n", count, x, y, z);
    count = sscanf(" 42 mm", "%d", &n);
    printf("%d %d\n", count, n);
    printf("%d\n", sscanf("none", "%d", &n));
}
//@ cycles: 29155
