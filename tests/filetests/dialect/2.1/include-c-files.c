//@ prints: 9 15
#include "KMotionDef.h"
#include "parts/square.c"

main() { printf("%d %d\n", square(3), cube_plus(2, 7)); }
//@ cycles: 4855
