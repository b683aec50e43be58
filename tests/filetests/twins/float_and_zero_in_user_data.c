//@ prints: 0 2.5
#include "KMotionDef.h"

main()
{
    float first;
    persist.UserData[10] = 0;
    first = *(float *)&persist.UserData[10];
    *(float *)&persist.UserData[11] = 2.5;
    persist.UserData[12] = persist.UserData[11];
    printf("%g %g\n", first, *(float *)&persist.UserData[12]);
}
