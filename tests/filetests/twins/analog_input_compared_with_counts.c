//@ args: --stim parts/adc.stim
#include "KMotionDef.h"

main()
{
    if (ADC(1) > 400 && ReadADC(1) > 448 && ADC(1) > 0) SetBit(46);
}
