#include "KMotionDef.h"

main()
{
    double *scale = (double *)&persist.UserData[140], sum = 0;
    int i;

    for (i = 0; i < 200; i++)
        sum += *scale * persist.UserData[142] + persist.UserData[143];
    persist.UserData[144] = sum;
}
