//@ prints: 0.6
#include "KMotionDef.h"

main()
{
    double next = Time_sec() + 0.1;
    WaitUntil(next);
    WaitUntil(Time_sec() + 0.5);
    printf("%.1f\n", Time_sec());
}
