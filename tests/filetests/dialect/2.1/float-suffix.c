//@ prints: 4 4 4 1
#include "KMotionDef.h"

main() { printf("%d %d %d %d\n", sizeof 1e-6f, sizeof 2.0F, sizeof 3.f, 0.1f != 0.1); }
//@ cycles: 8689
