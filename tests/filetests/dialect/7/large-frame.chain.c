//@ prints: 3
#include "KMotionDef.h"

inner() { int list[200]; list[0] = 1; return list[0]; }
middle() { int list[200]; list[0] = 1; return list[0] + inner(); }

outer() { int list[100]; list[0] = 1; return list[0] + middle(); }

main() { printf("%d\n", outer()); } //~ stack-size
//@ cycles: 2515
