//@ prints: 0 1 0
//@ prints: 1
#include "KMotionDef.h"

unsigned large = 0x80000000u;

main()
{
    int minus = -1;
    printf("%d %d %d\n", large < 1, minus < 1, minus < 2147483648); //~ negative-comparison
    printf("%d\n", (double *)0xfffffffc > gather_buffer);
}
//@ cycles: 9099
