//@ prints: 0 0.000000 0 0
#include "KMotionDef.h"

int scalar;
double array[100];

count() { static int calls; return calls; }

main()
{
    static char text[8];
    printf("%d %f %d %d\n", scalar, array[99], text[7], count());
}
//@ cycles: 11158
