//@ exit: 1
//@ says: `->`
//@ says: did you mean `Vel`
#include "KMotionDef.h"

main()
{
    ch0.Vel = 5; //~ error: `.Vel`
    chan[0]->Vel = 5; //~ error: `->`
    ch0->Velo = 5; //~ error: Velo
}
