//@ prints: 3
#include "KMotionDef.h"

int first(int n, ...) { return n; }

main() { printf("%d\n", first(3, 4.5, "text")); }
//@ cycles: 2485
