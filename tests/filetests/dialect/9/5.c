//@ prints: 40.000000
#include "KMotionDef.h"

main() { f(0.0, 40.0); } //~ implicit-declaration

f(float a, float b) { printf("%f\n", b); }
//@ cycles: 5667
