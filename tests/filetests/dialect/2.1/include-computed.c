//@ prints: beside
#define HEADER "KMotionDef.h"
#define PART <parts/where.h>
#include HEADER
#define QUOTED "parts/where.h"
#include QUOTED

main() { printf("%s\n", WHERE); }
//@ cycles: 2866
