//@ prints: 15 7 3 -56
#include "KMotionDef.h"

main()
{
    int i = 10, j = 5, k = 7;
    char c = 100;
    i *= 1.5;
    j += 2.9;
    k /= 2.1f;
    c += 100;
    printf("%d %d %d %d\n", i, j, k, c);
}
//@ cycles: 9409
