//@ prints: 2.500000 40040000 0
#include "KMotionDef.h"

double *values = (double *)persist.UserData;

main()
{
    values[10] = 2.5;
    printf("%f %x %d\n", ((double *)persist.UserData)[10], persist.UserData[21], persist.UserData[20]);
}
//@ cycles: 10800
