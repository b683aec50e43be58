//@ exit: 1
#include "KMotionDef.h"

int a;
double a; //~ error: `a`

main() { }
