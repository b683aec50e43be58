//@ prints: 5 2.500000 0 7 grün
#include "KMotionDef.h"

typedef int Number;
struct Nothing {};
double d = 2.5;

main()
{
    Number Number = 5;
    void *where = &&there;
    goto *where;
    Number = 6; //~ unreachable-code
there:
    printf("%d %f %d %d grün\n", Number, d, sizeof(struct Nothing), ({ int n = 7; n; }));
}
//@ cycles: 12292
