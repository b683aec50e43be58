//@ args: --stim parts/six_volts.stim
//@ prints: 0
//@ says: adc 0 = 6 is a number of counts, 0.029 V: write 6V for volts
#include "KMotionDef.h"

main()
{
    printf("%d\n", ADC(0));
}
