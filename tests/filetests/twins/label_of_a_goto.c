//@ prints: 3
#include "KMotionDef.h"

main()
{
    int i = 0;
again:
    i++;
    if (i < 3) goto again;
    printf("%d\n", i);
}
