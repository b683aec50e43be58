//@ prints: 4 7 5 3
#include "KMotionDef.h"

main()
{
    int a = 3, b = 3, c = 6, left = 1, width = 9;
    printf("%d %d ", (a + b + c) / 3, a + b + c / 6);
    printf("%d %d\n", left + width / 2, left + 1 + a / 3);
}
