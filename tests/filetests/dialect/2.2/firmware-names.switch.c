//@ args: run -Wportability
//@ prints: 7 8
#include "KMotionDef.h"

int s = 7; //~ redeclared: `s`
static int bb = 8;

main() { printf("%d %d\n", s, bb); }
