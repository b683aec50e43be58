//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    ch0->Velocity = 1000;
    chan[0]->Accel = 5;
    ch1.Jerk = 7;
}
