//@ prints: 465
//@ says: bytes of stack used; the board has about 1900
#include "KMotionDef.h"

deeper(int n) { int list[50]; list[0] = n; return n ? deeper(n - 1) + list[0] : 0; }

main() { printf("%d\n", deeper(30)); }
//@ processor: its stack is 2032 bytes
//@ cycles: 3471
