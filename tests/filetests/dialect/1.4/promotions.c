//@ prints: 400 -1 1 0 300
#include "KMotionDef.h"

unsigned char a = 200, b = 200;
short s = -1; //~ redeclared
struct { unsigned u : 9; } bits = { 300 };
static int constant = (unsigned char)200 + (unsigned char)200;
enum { FOLDED = (unsigned char)200 + (unsigned char)200, MIXED = -1 < 1u };

main()
{
    int n = -1;
    unsigned one = 1;
    printf("%d %d %d %d %d\n", a + b, s, (a + b == constant) & (constant == FOLDED), n < one | MIXED, bits.u); //~ negative-comparison
}
//@ cycles: 12048
