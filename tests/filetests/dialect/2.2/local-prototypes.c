//@ prints: 2.500000 7
#include "KMotionDef.h"

main()
{
    double half(double x);
    extern int n;
    printf("%f %d\n", half(5), n);
}

double half(double x) { return x / 2; }
int n = 7;
//@ cycles: 7044
