//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    ch8->Vel = 100;
}
