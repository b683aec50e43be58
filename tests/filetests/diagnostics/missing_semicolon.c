//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    ch0->Vel = 1000
    ch0->Accel = 2000;
    EnableAxis(0);
}
