//@ args: check
//@ says: warning[adc-counts]: `ReadADC` is a number of counts, and 5 counts are almost nothing
//@ says: analog_input_compared_with_volts.c:9:25
//@ says: write 1024 for 5 V
#include "KMotionDef.h"

main()
{
    while (ReadADC(1) < 5.0) WaitNextTimeSlice();
}
