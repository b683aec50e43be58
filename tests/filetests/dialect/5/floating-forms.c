//@ prints: [2.500000] [2.500000] [2] [2.50] [    2.500] [     3] [     2.500000] [2.5]
//@ prints: [ 0.333333333333] [           0] [    -1234.57]
#include "KMotionDef.h"

main()
{
    double d = 2.5, third = 1.0 / 3;
    float f = 2.5f;
    printf("[%f] [%lf] [%0.lf] [%.2f] [%9.3f] [%6.0f] [%13f] [%g]\n", d, d, 2.3, d, d, 3.4, f, d);
    printf("[%15.12f] [%12.0f] [%12.2f]\n", third, third, -1234.567);
}
//@ cycles: 55782
