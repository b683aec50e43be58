//@ args: check
//@ says: warning[value-range]: `DAC` takes values from -2048 to 2047, but this is 2048
//@ says: dac_value_too_high.c:10:5
#include "KMotionDef.h"

#define FULL_SPEED 2048

main()
{
    DAC(0, FULL_SPEED);
}
