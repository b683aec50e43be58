//@ snapshot
#include "KMotionDef.h"

main()
{
    int x = 0;
    if (x = 1) printf("%d\n", x);
}
//@ prints: 1
//@ cycles: 2481
