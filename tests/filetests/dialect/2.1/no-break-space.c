//@ byte: ␠ c2 a0
//@ prints: 5
#include "KMotionDef.h"

main()
{
    int␠a = 5; //~ lax-text: no-break space
    printf("%d\n", a);
}
//@ cycles: 2481
