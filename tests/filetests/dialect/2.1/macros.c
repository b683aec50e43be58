//@ prints: 7 16 16
#include "KMotionDef.h"
#define SEVEN 7
#define SQUARE(x) ((x) * (x))
#define TWICE(f, x) f(x)

main() { printf("%d %d %d\n", SEVEN, SQUARE(3 + 1), TWICE(SQUARE, 4)); }
//@ cycles: 7178
