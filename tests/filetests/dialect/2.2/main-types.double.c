//@ prints: 5
#include "KMotionDef.h"
double main() { printf("5\n"); return 2.5; }
//@ cycles: 784
