//@ prints: 0 3ff80000 -2.250000
#include "KMotionDef.h"

main()
{
    double d = 1.5;
    persist.UserData[20] = ((int *)&d)[0];
    persist.UserData[21] = ((int *)&d)[1];
    ((int *)&d)[1] = 0xc0020000;
    printf("%d %x %f\n", persist.UserData[20], persist.UserData[21], d);
}
//@ cycles: 10965
