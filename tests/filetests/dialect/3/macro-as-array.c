//@ exit: 1
#include "KMotionDef.h"

main()
{
    FPGA[5] = 3; //~ error: `FPGA` is not declared
}
