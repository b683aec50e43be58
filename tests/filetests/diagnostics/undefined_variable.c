//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int T0 = 5;
    if (t0 > 3) printf("%d\n", T0);
}
