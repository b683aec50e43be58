//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    double *where;

    where = 2.5;
    printf("%f\n", *where);
}
