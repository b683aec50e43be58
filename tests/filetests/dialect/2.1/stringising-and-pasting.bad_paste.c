//@ prints: 3
#include "KMotionDef.h"
#define JOIN(a, b) a##b

int a = JOIN(1, +) 2; //~ lax-text: pasting `1` and `+`

main() { printf("%d\n", a); }
//@ cycles: 2481
