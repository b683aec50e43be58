//@ exit: 1
//@ says: FPGA
#include "KMotionDef.h"

main()
{
    FPGA[5] = 3; //~ error: FPGA
}
