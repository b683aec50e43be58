//@ prints: 5 6 7
#include "KMotionDef.h"

extern int a;
int a = 5;
static int b = 6;
extern int b;
static int f();
int f() { return 7; }

main() { printf("%d %d %d\n", a, b, f()); }
//@ cycles: 6621
