//@ prints: 1 2 3 4 5 6 7 8 9 10 11.5
#include "KMotionDef.h"
main() { printf("%d %d %d %d %d %d %d %d %d %d %.1f\n", 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11.5); }
//@ cycles: 25250
