//@ prints: 7
#include "KMotionDef.h"

int add();

main() { printf("%d\n", add(3, 4)); }

int add(int a, int b) { return a + b; }
//@ cycles: 2492
