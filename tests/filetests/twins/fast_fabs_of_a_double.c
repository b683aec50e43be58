//@ prints: close 0.700000
#include "KMotionDef.h"

main()
{
    double error = ch0->Dest - ch0->Position - 0.7;
    if (fast_fabs(error) < 1) printf("close %f\n", fast_fabs(error));
}
