//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    fprintf("%d\n", 5);
    Jog(0);
    MoveRel(0, 10, 20);
}
