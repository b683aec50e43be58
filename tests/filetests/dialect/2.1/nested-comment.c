//@ prints: 5
#include "KMotionDef.h"

/* outer /* inner */ //~ lax-text: comment

main() { printf("5\n"); }
//@ cycles: 783
