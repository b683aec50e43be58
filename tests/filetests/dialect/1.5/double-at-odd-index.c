//@ prints: stored 3ff80000
//@ exit: 3
//@ says: which is not aligned
#include "KMotionDef.h"

main()
{
    double *d = (double *)&persist.UserData[11]; //~ user-data-alignment
    *d = 1.5;
    printf("stored %x\n", persist.UserData[12]);
    printf("%f\n", *d);
}
//@ cycles: 5494
