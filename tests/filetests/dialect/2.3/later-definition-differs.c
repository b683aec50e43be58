//@ prints: 40.000000 2.500000
#include "KMotionDef.h"

main()
{
    double d;
    f(0.0, 40.0); //~ implicit-declaration
    d = half(5); //~ implicit-declaration
    printf("%f\n", d);
}

f(float a, float b) { printf("%f ", b); }
double half(double x) { return x / 2; }
//@ cycles: 10638
