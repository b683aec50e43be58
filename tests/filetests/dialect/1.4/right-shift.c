//@ prints: -4 7ffffffc -1 1
//@ prints: -4 7ffffffc -1 1
//@ prints: -4 7ffffffc
#include "KMotionDef.h"

int minus = -7, one = 1, most = 31;
unsigned large = -7;
static int a = -7 >> 1, c = -7 >> 31;
static unsigned b = (unsigned)-7 >> 1, d = (unsigned)-7 >> 31;
enum { A = -7 >> 1, B = (unsigned)-7 >> 1 };

main()
{
    printf("%d %x %d %x\n", minus >> one, large >> one, minus >> most, large >> most);
    printf("%d %x %d %x\n", a, b, c, d);
    printf("%d %x\n", A, B);
}
//@ cycles: 27781
