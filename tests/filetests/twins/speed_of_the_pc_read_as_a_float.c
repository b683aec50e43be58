//@ prints: 0.000000
#include "KMotionDef.h"

main()
{
    float rpm = *(float *)&persist.UserData[113];
    printf("%f\n", rpm);
}
