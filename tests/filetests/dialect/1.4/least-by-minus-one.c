//@ prints: -2147483648 0 -2147483648 0 -2147483648 0
#include "KMotionDef.h"

int least = (int)0x80000000, minus = -1;
static int quotient = (int)0x80000000 / -1, remainder = (int)0x80000000 % -1;
enum { QUOTIENT = (int)0x80000000 / -1, REMAINDER = (int)0x80000000 % -1 };

main()
{
    printf("%d %d %d %d %d %d\n", least / minus, least % minus, quotient, remainder, QUOTIENT, REMAINDER);
}
//@ cycles: 20877
