//@ prints: 3 3
#include "KMotionDef.h"

main()
{
    int a, b;
    a = 1, b = 25;
    for (a = 0, b = 3; a < b; a++) ;
    printf("%d %d\n", a, b);
}
