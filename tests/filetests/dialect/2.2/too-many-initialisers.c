//@ exit: 1
#include "KMotionDef.h"

int list[2] = { 1, 2, 3 }; //~ error: too many
struct { int a; } s = { 1, 2 }; //~ error: too many

main() { }
