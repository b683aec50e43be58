//@ prints: 1 2 5 1
#include "KMotionDef.h"

enum First { IDLE = 1, MOVING = 2 };
int before() { return MOVING; }
enum Second { IDLE = 1, MOVING = 5 }; //~ redeclared: MOVING

main() { printf("%d %d %d %d\n", IDLE, before(), MOVING, IDLE); }
//@ cycles: 8690
