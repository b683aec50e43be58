// Bit-fields of 64 bits, across the middle word; promotion to the first of int and unsigned that holds all values.
//@ prints: 12345678900 -5 1 16
//@ prints: -1 1 0
//@ prints: 1099511627775 0
//@ prints: 7 3 9
#include "KMotionDef.h"

struct wide { unsigned long long low : 40; long long high : 23; unsigned long long flag : 1; long long own; };
struct narrow { unsigned long long five : 5; long long thirty : 30; unsigned int all : 32; };
struct wide start = { 0x123456789aULL, -2, 1, 9 };

main()
{
    struct wide w = { 12345678900ULL, -5, 1 };
    struct narrow n = { 31, -1, 0xffffffff };
    printf("%lld %d %d %d\n", (long long)w.low, (int)w.high, (int)w.flag, sizeof(w));
    printf("%d %d %d\n", n.five - 32, n.five > -1, n.all < 0);  //~ constant-comparison
    w.low = -1;
    w.high++;
    w.high += 4;
    printf("%lld %d\n", (long long)w.low, (int)w.high);
    n.five = 7;
    start.high = start.high + 5;
    printf("%d %d %d\n", n.five, (int)start.high, (int)start.own);
}
//@ cycles: 33393
