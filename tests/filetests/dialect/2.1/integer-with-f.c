//@ prints: 666 4
#include "KMotionDef.h"

main()
{
    printf("%d %d\n", 2000f / 3, sizeof 2000f); //~ integer-float-suffix //~ integer-float-suffix
}
//@ cycles: 5109
