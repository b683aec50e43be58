//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

EnableAxis(0);
ch0->Vel = 1000;
ch0->Accel = 5000;

main()
{
    Move(0, 100);
}
