//@ prints: 5
#include "KMotionDef.h"
#if 1 //~ lax-text: #endif

main() { printf("5\n"); }
//@ cycles: 783
