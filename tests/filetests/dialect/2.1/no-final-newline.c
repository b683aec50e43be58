//@ no-final-newline
//@ prints: end
#include "KMotionDef.h"

main() { printf("end\n"); } // the end
//@ cycles: 1157
