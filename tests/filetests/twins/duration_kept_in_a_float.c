//@ prints: 1
#include "KMotionDef.h"

main()
{
    double start = Time_sec();
    float duration;
    Delay_sec(0.1);
    duration = Time_sec() - start;
    printf("%d\n", duration > 0.09f);
}
