//@ prints: 1 2
#include "KMotionDef.h"

main()
{
    int a = 0, b = 0;
    if (a == 0)
        a = 1;
        b = 2; //~ misleading-indentation
    printf("%d %d\n", a, b);
}
//@ cycles: 4551
