//@ exit: 1
#include "KMotionDef.h"

int a, *p = &a, *q = &a;

main()
{
    int n;
    n = p + q; //~ error: `+`
    n = p * 2; //~ error: `*`
}
