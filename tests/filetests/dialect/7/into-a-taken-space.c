//@ args: run 2:parts/where.c
//@ exit: 2
//@ says: thread 2
#include "KMotionDef.h"

char table[80000];

main() { table[79999] = 1; }
