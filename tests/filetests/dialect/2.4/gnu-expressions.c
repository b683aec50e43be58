//@ prints: 6 2.500000
#include "KMotionDef.h"

main()
{
    int a = ({ int t = 5; t + 1; });
    typeof(2.5) d = 2.5;
    printf("%d %f\n", a, d);
}
//@ cycles: 7031
