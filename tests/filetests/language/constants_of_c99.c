// A large decimal constant is signed from C99 on.
//@ args: --std c99
//@ prints: 1 8 199901
#include "KMotionDef.h"

main()
{
    printf("%d %d %d\n", -1 < 2147483648, sizeof(2147483648), __STDC_VERSION__);
}
