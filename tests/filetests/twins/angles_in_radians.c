//@ prints: 1.000000 1.000000 0.546302
#include "KMotionDef.h"

main()
{
    printf("%f %f %f\n", sin(90 * PI / 180), cos(TWO_PI), tan(0.5));
}
