//@ prints: 2
#include "KMotionDef.h"

f() { return 1; }
g() { return f(); }
f() { return 2; } //~ redeclared

main() { printf("%d\n", g()); }
//@ cycles: 2488
