//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

void Limits(CHAN &axis)
{
    axis.Vel = 1000;
}

main()
{
    Limits(chan[0]);
}
