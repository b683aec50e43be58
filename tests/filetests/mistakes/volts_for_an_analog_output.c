//@ args: check
//@ says: warning[dac-counts]: `DAC` takes a number of counts, and 5 counts are almost nothing
//@ says: volts_for_an_analog_output.c:9:5
#include "KMotionDef.h"

main()
{
    SetBit(46);
    DAC(0, 5);
}
