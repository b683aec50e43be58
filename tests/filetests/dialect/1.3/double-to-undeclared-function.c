//@ prints: 40.000000 7
#include "KMotionDef.h"

main()
{
    f(40.0, 7.9); //~ implicit-declaration: is called before it is declared
    //~^ lost-fraction
}

f(float a, int b) { printf("%f %d\n", a, b); }
//@ cycles: 7736
