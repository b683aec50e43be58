//@ prints: 0.000000
//@ says: adc_channel_that_nothing_drives.c:9:19 in `main`: ReadADC(2): nothing drives analog input 2; it stays 0
#include "KMotionDef.h"

main()
{
    double volts;

    volts = 0.5 * ReadADC(2);
    printf("%f\n", volts);
}
