//@ args: check
//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

void Store(float *to)
{
    *to = 1;
}

main()
{
    float f = 2;
    int i;
    Store(f);
    printf("%d\n", f);
    i = Readbit(46);
    printf("%d\n", i);
}
