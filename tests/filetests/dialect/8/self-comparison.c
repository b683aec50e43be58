//@ prints: 0
#include "KMotionDef.h"

double speed = 1.5;

main() { printf("%d\n", speed != speed); } //~ self-comparison
//@ cycles: 2484
