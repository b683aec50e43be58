//@ prints: 0
//@ prints: 0.25
//@ prints: 0.5
//@ prints: 0.75
//@ prints: 0
//@ prints: 0.1
//@ prints: 0.2
#include "KMotionDef.h"

main()
{
    double x;
    for (x = 0; x != 1; x += 0.25) printf("%g\n", x);
    for (x = 0; x < 0.25; x += 0.1) printf("%g\n", x);
}
