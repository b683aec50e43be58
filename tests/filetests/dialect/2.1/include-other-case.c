//@ prints: beside
#include "kmotiondef.H"
#include "Parts\WHERE.h"
//~^ note-if-case-matters: parts/where.h

main() { printf("%s\n", WHERE); }
//@ cycles: 2866
