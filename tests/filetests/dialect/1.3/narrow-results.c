//@ prints: -56 -32768 255
#include "KMotionDef.h"

char c(int n) { return n; }
short s(int n) { return n; } //~ redeclared
unsigned char u(int n) { return n; }

main()
{
    printf("%d %d %d\n", c(200), s(32768), u(-1));
}
//@ cycles: 8894
