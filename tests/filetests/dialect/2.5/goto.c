//@ prints: 1 2 4 8
#include "KMotionDef.h"

main()
{
    int i = 1;
again:
    printf(i < 8 ? "%d " : "%d\n", i);
    i *= 2;
    if (i <= 8) goto again;
}
//@ cycles: 9930
