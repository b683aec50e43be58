//@ args: check
//@ says: warning[dac-counts]: `DAC` takes a number of counts, and `volts` looks like volts
//@ says: volts_of_a_spindle_in_a_variable.c:10:5
#include "KMotionDef.h"

void Speed(double rpm)
{
    int volts = rpm / 3000.0 * 10.0;

    DAC(0, volts);
}

main()
{
    Speed(1500);
}
