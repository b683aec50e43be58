//@ prints: 0
#include "KMotionDef.h"

large() //~ stack-size
{
    int list[300];
    list[0] = 0;
    return list[0];
}

main() { printf("%d\n", large()); }
//@ cycles: 2491
