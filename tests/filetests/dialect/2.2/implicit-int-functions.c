//@ prints: 7 -1
#include "KMotionDef.h"

add(int a, int b) { return a + b; }
static sign(double x) { return x < 0 ? -1 : 1; }

main() { printf("%d %d\n", add(3, 4), sign(-2.5)); }
//@ cycles: 4711
