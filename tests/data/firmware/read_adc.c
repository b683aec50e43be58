// ReadADC returns the reading of the macro ADC, not the conversion.
#include "KMotionDef.h"

main()
{
    ADC_BufferIn[2] = 2048;
    ADC_BufferIn[3] = 3277;
    printf("%d %d %d\n", ReadADC(2), ADC(2), ADC_BufferIn[2]);
    printf("%d %d %d\n", ReadADC(3), ADC(3), ADC_BufferIn[3]);
}
