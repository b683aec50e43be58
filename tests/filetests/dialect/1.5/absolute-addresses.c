//@ prints: 1 1 1
#include "KMotionDef.h"

volatile double *flash = (volatile double *)0x90100000;
double *end = (double *)0xfffffffc;

main()
{
    int before = TIMER0, after;
    Delay_sec(0.001);
    after = TIMER0;
    printf("%d %d %d\n", before != after, (double *)gather_buffer < end, flash != 0);
}
//@ cycles: 6873
