//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    double x = 2 ch0->Position;

    Move(0, x);
}
