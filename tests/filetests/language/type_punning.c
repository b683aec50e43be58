// Memory is bytes: integers, floats and doubles share it.
//@ prints: 3f9d70a4 1.230000
//@ prints: 0 3ff80000 1.500000
//@ prints: PERS
//@ says: strcpy
#include "KMotionDef.h"

float *p = (float *)&persist.UserData[10];

main()
{
    double d = 1.5;
    *p = 1.23f;
    printf("%x %f\n", persist.UserData[10], *(float *)&persist.UserData[10]);
    persist.UserData[20] = ((int *)&d)[0];
    persist.UserData[21] = ((int *)&d)[1];
    printf("%d %x %f\n", persist.UserData[20], persist.UserData[21], ((double *)persist.UserData)[10]);
    strcpy((char *)gather_buffer + 1, "PERS");
    printf("%s\n", (char *)gather_buffer + 1);
}
//@ cycles: 22042
