// Target arithmetic: 32-bit wrap, division toward zero, shift counts modulo 64, saturating conversions.
//@ says: shift-count
//@ prints: -3 -1 -3 1
//@ prints: -2147483648 -2147483648 0
//@ prints: 0 2 -1 0
//@ prints: 2147483647 -2147483648 2147483647
//@ prints: 4294967295 3 -56
#include "KMotionDef.h"

int seven = 7, minus = -7, two = 2, least = 0x80000000, one = 1;
double big = 1e10;

main()
{
    double zero = 0.0;
    unsigned u;
    printf("%d %d %d %d\n", minus / two, minus % two, seven / -two, seven % -two);
    printf("%d %d %d\n", 2147483647 + one, least / -one, least % -one);
    printf("%d %d %d %d\n", one << 33, one << 65, minus >> 40, (int)((unsigned)minus >> 40));
    printf("%d %d %d\n", (int)big, (int)-big, (int)(zero / zero));
    u = 4294967295.0;
    printf("%u %u %d\n", u, (unsigned)3.99, (char)200);
}
//@ cycles: 53993
