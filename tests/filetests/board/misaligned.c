//@ exit: 3
//@ says: which is not aligned
#include "KMotionDef.h"
main()
{
    double *d = (double *)&persist.UserData[1];
    *d = 1.5;
    return *d;
}
//@ cycles: 7
