//@ prints: 17 A 1.500000e+00 % [   7] [7   ] [+7] [ 7] [0x1f] [4464]
#include "KMotionDef.h"

main()
{
    printf("%o %c %e %% [%*d] [%-4d] [%+d] [% d] [%#x] [%hu]\n", 15, 'A', 1.5, 4, 7, 7, 7, 7, 31, 70000);
}
//@ cycles: 29029
