//@ exit: 1
#include "KMotionDef.h"

main()
{
    int a[]; //~ error: `a`
    a[0] = 5;
}
