//@ prints: 9 beside
#include "KMotionDef.h"
#include "..\2.1\parts\square.c"
#include "..\2.1\Parts\Where.h"
//~^ note-if-case-matters: where.h

main() { printf("%d %s\n", square(3), WHERE); }
//@ cycles: 4946
