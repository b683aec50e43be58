//@ prints: 5
#include "KMotionDef.h"

#if 0
This isn't C, and it's "not closed.
#error don't stop here
#endif
#pragma TI_COMPILER don't mind

main() { printf("5\n"); }
//@ cycles: 783
