//@ prints: 1.0
#include "KMotionDef.h"

main()
{
    double minutes = 0.001;
    Delay_sec(0.5);
    Delay_sec(minutes * 60);
    printf("%.1f\n", Time_sec() > 0.5 ? 1.0 : 0.0);
}
