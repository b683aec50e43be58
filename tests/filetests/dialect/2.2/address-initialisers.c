//@ prints: 1.500000 3fc00000
#include "KMotionDef.h"

float *speed = &persist.UserData[12];
int *raw = &persist.UserData[12];
double *pair = (double *)&persist.UserData[14];

main()
{
    *speed = 1.5;
    *pair = 2.5;
    printf("%f %x\n", *speed, *raw);
}
//@ cycles: 8706
