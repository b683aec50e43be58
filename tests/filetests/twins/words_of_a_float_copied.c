//@ prints: 2.500000
#include "KMotionDef.h"

main()
{
    *(float *)&persist.UserData[20] = 2.5f;
    persist.UserData[30] = persist.UserData[20];
    printf("%f\n", *(float *)&persist.UserData[30]);
}
