//@ prints: beside
#include "KMotionDef.h"
#include "parts/where.h"
#include "parts/where.h"

main() { printf("%s\n", WHERE); }
//@ cycles: 2866
