//@ prints: 3628800 55
#include "KMotionDef.h"

int factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }
int odd(int n);
int even(int n) { return n ? odd(n - 1) : 1; }
int odd(int n) { return n ? even(n - 1) : 0; }
int fibonacci(int n) { return n < 2 ? n : fibonacci(n - 1) + fibonacci(n - 2); }

main() { printf("%d %d\n", factorial(10) * even(20), fibonacci(10)); }
//@ cycles: 8161
