//@ args: check
//@ says: warning[constant-conversion]: 1000 does not fit in a value of type `unsigned char`
//@ says: pwm_register_written_with_1000.c:8:21
#include "KMotionDef.h"

main()
{
    FPGA(IO_PWMS) = 1000;
}
