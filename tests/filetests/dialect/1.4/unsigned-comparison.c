//@ prints: 0 1 0 1
//@ prints: 0 1 0
//@ prints: 1 1
#include "KMotionDef.h"

unsigned large = 0x80000000u, one = 1;
static int a = 0x80000000u < 1, b = 0x80000000u >= 1, c = -1 < 1u;

main()
{
    int minus = -1;
    printf("%d %d %d %d\n", large < one, large >= one, minus < one, large > 0x7fffffff); //~ negative-comparison
    printf("%d %d %d\n", a, b, c);
    printf("%d %d\n", (double *)0xfffffffc > gather_buffer, (char *)0x80000000 > (char *)1);
}
//@ cycles: 19863
