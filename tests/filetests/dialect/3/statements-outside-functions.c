//@ exit: 1
#include "KMotionDef.h"

ch0->Vel = 1000; //~ error: statement outside a function
main() { }
