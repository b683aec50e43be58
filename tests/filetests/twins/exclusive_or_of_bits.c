//@ prints: 0 16
#include "KMotionDef.h"

main()
{
    int level = 1, mask = 0x2 ^ 0x10;
    level = level ^ 1;
    printf("%d %d\n", level, mask ^ 2);
}
