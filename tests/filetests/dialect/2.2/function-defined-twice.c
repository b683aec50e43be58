//@ prints: 2 2
#include "KMotionDef.h"

f() { return 1; }
g() { return f(); }
f() { return 2; } //~ redeclared: defined twice

main() { printf("%d %d\n", g(), f()); }
//@ cycles: 4558
