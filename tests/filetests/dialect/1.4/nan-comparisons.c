//@ prints: 0 0 0 0 0 1
//@ prints: 0 0 0 0 0 1
#include "KMotionDef.h"

double zero, one = 1;
static int a = 0.0 / 0.0 < 1, b = 0.0 / 0.0 > 1, c = 0.0 / 0.0 <= 1, d = 0.0 / 0.0 >= 1, e = 0.0 / 0.0 == 1, f = 0.0 / 0.0 != 1;

main()
{
    double n = zero / zero;
    printf("%d %d %d %d %d %d\n", n < one, n > one, n <= one, n >= one, n == one, n != one);
    printf("%d %d %d %d %d %d\n", a, b, c, d, e, f);
}
//@ cycles: 25695
