//@ exit: 1
//@ says: bytes too large
#include "KMotionDef.h"

char table[0xb0000];

main() { table[5] = 1; }
