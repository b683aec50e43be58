//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    Move(0);
    Jog(0, 100, 5);
}
