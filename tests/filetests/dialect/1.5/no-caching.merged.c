//@ prints: 1 2 3
#include "KMotionDef.h"

int count;
int *alias = &count;

main()
{
    int a, b, c;
    *alias = 1;
    a = count;
    *alias = 2;
    b = count;
    (*alias)++;
    c = count;
    printf("%d %d %d\n", a, b, c);
}
//@ cycles: 6631
