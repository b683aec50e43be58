//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

/* Homes the X axis.
main()
{
    Jog(0, -1000);
}
