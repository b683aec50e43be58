//@ prints: beside nested
#include "KMotionDef.h"
#include "parts/where.h"

main() { printf("%s %s\n", WHERE, NESTED); }
//@ cycles: 5321
