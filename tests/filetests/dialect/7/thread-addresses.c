//@ args: run 4:parts/where.c
//@ prints: thread 1 at 0x8005
//@ prints: thread 4 at 0x8008
#include "KMotionDef.h"

main() { printf("thread %d at 0x%x\n", CurrentThread, (unsigned)main >> 16); }
