//@ prints: 5
#include "KMotionDef.h"
void main(void) { printf("5\n"); }
//@ cycles: 783
