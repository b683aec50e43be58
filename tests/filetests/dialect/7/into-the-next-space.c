//@ prints: 80000
//@ says: thread 2
#include "KMotionDef.h"

char table[80000];

main() { table[79999] = 1; printf("%d\n", sizeof table); }
//@ cycles: 3599
