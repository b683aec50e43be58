//@ prints: 1 1 1 0 1
//@ prints: 1 1 1
#include "KMotionDef.h"

double zero = 0, one = 1;
float single_zero = 0;
static double infinite = 1.0 / 0.0, nan = 0.0 / 0.0;

main()
{
    double n = zero / zero;
    printf("%d %d %d %d %d\n", one / zero > 1e308, -one / zero < -1e308, 1.0f / single_zero > 1e38f, n == zero / zero, n != zero);
    printf("%d %d %d\n", infinite == one / zero, !(nan < 0), !(nan >= 0));
}
//@ cycles: 17543
