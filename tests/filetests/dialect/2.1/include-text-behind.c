//@ prints: 9
#include "KMotionDef.h" // the board
#include "parts/square.c";

main() { printf("%d\n", square(3)); }
//@ cycles: 2491
