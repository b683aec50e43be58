//@ prints: 7
#include "helper-without-main.c"

main() { printf("%d\n", helper()); }
//@ cycles: 2488
