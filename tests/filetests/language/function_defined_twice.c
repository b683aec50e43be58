// The last definition wins, for earlier calls too.
//@ prints: 2
//@ says: defined twice
#include "KMotionDef.h"

f() { return 1; }
g() { return f(); }
f() { return 2; }

main() { printf("%d\n", g()); }
//@ cycles: 2488
