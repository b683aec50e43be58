//@ byte: ␚ 1a
//@ prints: 5
//@ cycles: 783
#include "KMotionDef.h"
main() { printf("5\n"); }
␚
