//@ prints: 5
#include "KMotionDef.h"
static main() { printf("5\n"); } //~ extension: main
//@ cycles: 783
