//@ args: run -Wportability
//@ prints: 5.00
#include "KMotionDef.h"

main() { printf("%.2f\n", hypot(3, 4)); } //~ implicit-declaration //~ portability: hypot
