//@ prints: 3 -2 1000000
#include "KMotionDef.h"
main() { printf("%0.lf %0.lf %0.lf\n", 2.7, -1.6, 1e6); }
//@ cycles: 14296
