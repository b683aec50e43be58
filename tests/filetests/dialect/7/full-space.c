//@ prints: 60000
#include "KMotionDef.h"

char table[60000];

main() { printf("%d\n", sizeof table); }
//@ cycles: 3597
