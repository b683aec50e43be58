//@ prints: 5
#include "KMotionDef.h"
main() { printf("5\n"); }
//@ cycles: 783
