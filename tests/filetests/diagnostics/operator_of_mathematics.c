//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    double x = ch0->Position, y = ch1->Position;

    printf("%f\n", sqrt(x^2 + y^2));
}
