//@ prints: 7 8
#include "KMotionDef.h"

static inline int seven(void) { return 7; }
int first(const char *restrict text) { return text[0]; }
__extension__ int eight(void) __attribute__((noinline));
int eight(void) { return 8; }
int unused __attribute__((unused));

main() { printf("%d %d\n", seven(), eight()); }
//@ cycles: 4551
