␂#include "KMotionDef.h"
main() { printf("5\n"); }
//@ byte: ␂ ef bb bf
//@ prints: 5
//@ cycles: 783
