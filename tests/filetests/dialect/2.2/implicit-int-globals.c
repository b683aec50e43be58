//@ prints: 0 5 0 7 3
#include "KMotionDef.h"

x; //~ implicit-int
y = 5; //~ implicit-int
static z; //~ implicit-int
extern w; //~ implicit-int
int w = 7;
f(const n) { return n; } //~ implicit-int

main() { printf("%d %d %d %d %d\n", x, y, z, w, f(3)); }
//@ cycles: 10761
