//@ prints: 199
#include "KMotionDef.h"

main()
{
    int i = 3;
    persist.UserData[199] = 199;
    if (i > 5) persist.UserData[200] = 5; //~ user-data-index
    if (i > 5) *(double *)&persist.UserData[151] = 2.5; //~ user-data-alignment
    printf("%d\n", persist.UserData[199]);
}
//@ cycles: 3045
