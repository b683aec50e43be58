//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    ch0->Acceleration = 1000;
    ch0->velocity = 50;
    ch0->MaxFollowingErr = 10;
}
