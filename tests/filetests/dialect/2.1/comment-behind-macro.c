//@ prints: 47 48
#include "KMotionDef.h"
#define LAMP 47 // the green one
#define PUMP 48 /* coolant */

main() { printf("%d %d\n", LAMP, PUMP); }
//@ cycles: 5109
