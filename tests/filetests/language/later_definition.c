// A call before the definition converts to the definition's parameters and takes its result.
//@ prints: 40.000000 2.500000
//@ says: float
#include "KMotionDef.h"

main()
{
    f(0.0, 40.0);
}

double half(double x);

f(float a, float b)
{
    printf("%f %f\n", b, half(5));
}

double half(double x) { return x / 2; }
//@ cycles: 10230
