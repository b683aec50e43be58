//@ exit: 1
#include "KMotionDef.h"

typedef int Number;
typedef int Number;
typedef double Number; //~ error: Number

main() { }
