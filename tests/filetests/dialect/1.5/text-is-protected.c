//@ exit: 3
//@ says: which holds program text
#include "KMotionDef.h"

void f() { }

main()
{
    *(int *)f = 0;
}
//@ cycles: 4
