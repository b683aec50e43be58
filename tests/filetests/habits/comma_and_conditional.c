// Two counters in one loop, a choice inside a call, several stores in one statement.
//@ prints: 0/4 1/3 2/2 
//@ prints: odd even 9 9
#include "KMotionDef.h"

main()
{
    int i, j, a, b;
    for (i = 0, j = 4; i <= j; i++, j--) printf("%d/%d ", i, j);
    printf("\n");
    a = b = 9;
    printf("%s %s %d %d\n", a & 1 ? "odd" : "even", (a + b) & 1 ? "odd" : "even", a, (i = 5, b));
}
//@ cycles: 22861
