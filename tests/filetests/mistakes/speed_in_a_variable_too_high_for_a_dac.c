//@ args: check
//@ says: warning[value-range]: `DAC` takes values from -2048 to 2047, but this is 3000
//@ says: speed_in_a_variable_too_high_for_a_dac.c:9:5
#include "KMotionDef.h"

main()
{
    int speed = 3000;
    DAC(2, speed);
}
