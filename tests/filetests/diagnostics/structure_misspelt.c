//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

void Setup(CHANNEL *axis)
{
    axis->Vel = 1000;
}

main()
{
    Setup(ch0);
}
