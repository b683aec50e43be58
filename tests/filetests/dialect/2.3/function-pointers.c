//@ prints: 7 7 7 -1 12
#include "KMotionDef.h"

int add(int a, int b) { return a + b; }
int subtract(int a, int b) { return a - b; }
struct Operation { char *name; int (*run)(int, int); } table[] = { { "add", add }, { "subtract", &subtract } };

main()
{
    int (*p)(int, int) = add;
    int (*q)() = &add;
    printf("%d %d %d %d ", p(3, 4), (*p)(3, 4), q(3, 4), table[1].run(3, 4));
    p = table[0].run;
    printf("%d\n", (**p)(5, 7));
}
//@ cycles: 11668
