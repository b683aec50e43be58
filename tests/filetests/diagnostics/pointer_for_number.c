//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    double position;

    position = ch0;
    Move(0, &position);
}
