//@ prints: 5 3
#include "KMotionDef.h"

int f(int n);
unsigned long g(int n);

main() { printf("%d %d\n", f(4), g(2)); }

int f(int n, int more) { return n + 1; } //~ prototype-mismatch
int g(int n) { return n + 1; } //~ prototype-mismatch
//@ cycles: 4570
