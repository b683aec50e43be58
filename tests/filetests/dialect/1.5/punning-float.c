//@ prints: 3f9d70a4 1.230000
#include "KMotionDef.h"

main()
{
    *(float *)&persist.UserData[10] = 1.23f;
    printf("%x %f\n", persist.UserData[10], *(float *)&persist.UserData[10]);
}
//@ cycles: 8700
