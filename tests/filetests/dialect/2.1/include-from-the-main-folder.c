//@ prints: found
#include "KMotionDef.h"
#include "parts/looks_up.h"

main() { printf("%s\n", FOUND); }
//@ cycles: 2698
