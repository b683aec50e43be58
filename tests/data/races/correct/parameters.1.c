#include "KMotionDef.h"

main()
{
    double *scale = (double *)&persist.UserData[140];

    *scale = 25.4;
    persist.UserData[142] = 7;
    persist.UserData[143] = 3;
    StartThread(2);
}
