//@ exit: 1
#include "KMotionDef.h"

int a = 5;
int a = 6; //~ error: `a`

main() { }
