//@ prints: -3 -1 -3 1 3 -1
//@ prints: -3 -1 -3 1 3 -1
//@ prints: -3 -1 -3 1 3 -1
//@ prints: 2147483644 1
#include "KMotionDef.h"

int seven = 7, minus = -7, two = 2, minus_two = -2;
unsigned large = -7;
static int a = -7 / 2, b = -7 % 2, c = 7 / -2, d = 7 % -2, e = -7 / -2, f = -7 % -2;
enum { A = -7 / 2, B = -7 % 2, C = 7 / -2, D = 7 % -2, E = -7 / -2, F = -7 % -2 };

main()
{
    printf("%d %d %d %d %d %d\n", minus / two, minus % two, seven / minus_two, seven % minus_two,
           minus / minus_two, minus % minus_two);
    printf("%d %d %d %d %d %d\n", a, b, c, d, e, f);
    printf("%d %d %d %d %d %d\n", A, B, C, D, E, F);
    printf("%u %u\n", large / 2, large % 2);
}
//@ cycles: 47562
