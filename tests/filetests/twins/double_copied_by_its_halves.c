//@ args: check
#include "KMotionDef.h"

main()
{
    double *d = (double *)persist.UserData;
    persist.UserData[140] = persist.UserData[160];
    persist.UserData[141] = persist.UserData[161];
    printf("%.3f\n", d[70]);
    persist.UserData[150] = 1;
}
