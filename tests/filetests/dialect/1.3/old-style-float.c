//@ prints: 2.500000 4
#include "KMotionDef.h"

void show(f, n) //~ old-style-definition
float f;
int n;
{
    printf("%f %d\n", f, n);
}

main()
{
    show(2.5, 4);
}
//@ cycles: 7042
