//@ prints: 2600 2 3 2.6
#include "KMotionDef.h"

main()
{
    double len = 2.6;
    persist.UserData[40] = len * 1000;
    persist.UserData[41] = (int)len;
    persist.UserData[42] = len + 0.5;
    persist.UserData[43] = ch0->Dest;
    *(float *)&persist.UserData[44] = len;
    *(double *)&persist.UserData[60] = len;
    *(double *)&persist.UserData[62] = len;
    printf("%d %d %d %g\n", persist.UserData[40], persist.UserData[41], persist.UserData[42], *(double *)&persist.UserData[60]);
}
