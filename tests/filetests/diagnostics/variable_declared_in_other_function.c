//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

void Measure(void)
{
    double result = ch0->Position;
}

main()
{
    Measure();
    printf("%f\n", result);
}
