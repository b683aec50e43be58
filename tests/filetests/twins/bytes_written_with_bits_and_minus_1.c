//@ prints: 255 -1 -1
#include "KMotionDef.h"

main()
{
    unsigned char all = -1;
    char mask = 0xff;
    short word = 0xffff;
    FPGA(IO_PWMS) = 255;
    printf("%d %d %d\n", all, mask, word);
}
