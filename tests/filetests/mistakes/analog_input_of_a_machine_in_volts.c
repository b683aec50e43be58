//@ args: --machine parts/pot.toml
//@ prints: 0.0 V
//@ says: adc 2 = 7.5 is a number of counts, 0.037 V: write "7.5V" for volts
#include "KMotionDef.h"

main()
{
    Delay_sec(0.2);
    printf("%.1f V\n", KANALOG_CONVERT_ADC_TO_VOLTS(ADC(2)));
}
