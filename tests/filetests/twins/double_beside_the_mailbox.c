//@ prints: 0.375000
#include "KMotionDef.h"

#define PUT(n, v) (*(double *)&persist.UserData[(n) * 2] = (v))

main()
{
    PUT(49, 1.0 / 4);
    PUT(54, 1.0 / 8);
    printf("%f\n", *(double *)&persist.UserData[98] + *(double *)&persist.UserData[108]);
}
