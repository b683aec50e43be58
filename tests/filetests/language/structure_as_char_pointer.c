// Other compilers only warn too.
//@ prints: 7
#include "KMotionDef.h"

struct Pair { int a, b; } pair = { 7, 8 };

main()
{
    char *bytes = &pair; //~ pointer-mismatch
    printf("%d\n", bytes[0]);
}
//@ cycles: 2481
