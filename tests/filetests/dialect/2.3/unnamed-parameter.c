//@ prints: 4
#include "KMotionDef.h"

int second(int, int b) { return b; }

main() { printf("%d\n", second(3, 4)); }
//@ cycles: 2481
