//@ args: run -Wlate-definition
//@ prints: 7
#include "KMotionDef.h"

main() { printf("%d\n", add(3, 4)); } //~ late-definition

add(int a, int b) { return a + b; }
