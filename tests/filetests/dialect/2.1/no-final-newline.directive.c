//@ no-final-newline
//@ prints: end
#include "KMotionDef.h"

main() { printf("end\n"); }
#define LAST 5
//@ cycles: 1157
