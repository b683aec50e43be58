//@ prints: 3ff80000 1 1
#include "KMotionDef.h"

int value = 5;
double d = 1.5;

main()
{
    unsigned *u = &value;
    volatile int *v = &value;
    char *c;
    int *p;
    c = &value;
    p = &d; //~ pointer-mismatch
    printf("%x %d %d\n", p[1], *u == *v, *c == 5);
}
//@ cycles: 8321
