//@ prints: 7
#include "KMotionDef.h"

main()
{
    *(float *)&persist.UserData[20] = 2.5f;
    persist.UserData[20] = 7;
    printf("%d\n", persist.UserData[20]);
}
