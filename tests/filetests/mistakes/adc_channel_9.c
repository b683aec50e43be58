//@ prints: -2048
//@ says: thread 1 at adc_channel_9.c:7:20 in `main`: ReadADC(9): no such channel (0-7)
#include "KMotionDef.h"

main()
{
    printf("%d\n", ReadADC(9));
}
