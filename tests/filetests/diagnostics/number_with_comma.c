//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    double scale = 2,54;

    Move(0, scale);
}
