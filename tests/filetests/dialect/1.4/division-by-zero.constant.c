//@ exit: 1
//@ says: this is a division by zero
#include "KMotionDef.h"

int a = 5 / 0; //~ error: must be constant
enum { B = 5 % 0 }; //~ error: division by zero

main() { }
