//@ args: --machine parts/pot.toml
//@ prints: 7.5 V
#include "KMotionDef.h"

main()
{
    Delay_sec(0.2);
    printf("%.1f V\n", KANALOG_CONVERT_ADC_TO_VOLTS(ADC(2)));
}
