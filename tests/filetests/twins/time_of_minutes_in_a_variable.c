//@ args: --for 0.5 --time
//@ prints: 0.300252 over
#include "KMotionDef.h"

main()
{
    double minutes = 0.005;
    Delay_sec(60 * minutes);
    printf("over\n");
}
