//@ prints: 9
#include "KMotionDef.h"
#define SQUARE(x) ((x) * (x))

main() { printf("%d\n", SQUARE /* of three */ (3)); }
//@ cycles: 2481
