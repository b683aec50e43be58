//@ prints: 1.500000
#include "KMotionDef.h"

main()
{
    float *f = (float *)&persist.UserData[10];
    double *d;
    int list[2];
    *f = 1.5;
    d = list; //~ pointer-mismatch
    printf("%f\n", *(float *)&persist.UserData[10]);
}
//@ cycles: 4934
