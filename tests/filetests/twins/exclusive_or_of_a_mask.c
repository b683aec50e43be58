//@ prints: 24
#include "KMotionDef.h"

main()
{
    int flags = 0x12;
    flags = flags ^ 2;
    flags ^= 1 << 3;
    printf("%d\n", flags);
}
