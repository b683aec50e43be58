//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int pulse;

    pulse = FPGA[0x12];
    printf("%d\n", pulse);
}
