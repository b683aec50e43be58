//@ prints: 1 2
#include "KMotionDef.h"

main()
{
    int a = 1;
    printf("%d ", a);
    int a = 2; //~ redeclared: a
    printf("%d\n", a);
}
//@ cycles: 4957
