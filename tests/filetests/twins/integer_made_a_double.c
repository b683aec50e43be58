//@ prints: 2.400000
#include "KMotionDef.h"

main()
{
    double n;
    persist.UserData[40] = 12;
    n = persist.UserData[40];
    printf("%f\n", n / 5);
}
