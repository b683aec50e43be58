//@ prints: [7] [ 7] [   7] [    7] [-7] [4294967289]
//@ prints: [fff9] [f] [0f] [000f] [0000000f] [0F] [000F] [00000F] [   F]
#include "KMotionDef.h"

main()
{
    int n = 7;
    printf("[%d] [%2d] [%4d] [%5d] [%i] [%u]\n", n, n, n, n, -n, -n);
    printf("[%x] [%x] [%02x] [%04x] [%08x] [%02X] [%04X] [%06X] [%4X]\n", -n & 0xffff, 15, 15, 15, 15, 15, 15, 15, 15);
}
//@ cycles: 47185
