// Registers by the header's macros, read, changed and written back.
//@ args: run --verbose
//@ says: FPGA register 0x2f0 is unknown
//@ says: FPGA register 0x2f4 is unknown
//@ prints: 11
//@ prints: 1234
#include "KMotionDef.h"

#define MY_REGISTER 0x2f0

main()
{
    FPGA(MY_REGISTER) = 0x10;
    FPGA(MY_REGISTER) = FPGA(MY_REGISTER) | 1;
    printf("%x\n", FPGA(MY_REGISTER));
    FPGAW(MY_REGISTER + 4) = 0x1234;
    printf("%x\n", FPGAW(MY_REGISTER + 4));
}
