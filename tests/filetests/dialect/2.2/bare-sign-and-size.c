//@ prints: 1 -1 2 4
#include "KMotionDef.h"

unsigned a = -1;
signed b = -1;
short c;
long d;

main() { printf("%d %d %d %d\n", a > 0, b, sizeof c, sizeof d); }
//@ cycles: 8852
