//@ exit: 3
//@ says: stack
#include "KMotionDef.h"

deeper(int n) { int list[50]; list[0] = n; return deeper(n + 1) + list[0]; }

main() { deeper(0); }
//@ cycles: 1365
