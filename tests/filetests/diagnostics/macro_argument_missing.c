//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

#define SCALED(x, y) ((x) * (y))

main()
{
    Move(0, SCALED(10));
}
