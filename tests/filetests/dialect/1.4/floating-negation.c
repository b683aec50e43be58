//@ prints: -1.500000 2.500000 1 1
#include "KMotionDef.h"

double a = 1.5, zero = 0;
float f = -2.5f;
static double folded = -1.5;

main()
{
    printf("%f %f %d %d\n", -a, -f, -zero == 0, folded == -a);
}
//@ cycles: 13792
