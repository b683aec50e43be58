//@ prints: 1 2 3
#include "KMotionDef.h"

count() { static int n = 0; return ++n; }

main() { printf("%d %d %d\n", count(), count(), count()); }
//@ cycles: 6627
