//@ prints: 41
#include "KMotionDef.h"

void f() { return 65; }

main() { printf("%X\n", f()); } //~ void-value
//@ cycles: 2707
