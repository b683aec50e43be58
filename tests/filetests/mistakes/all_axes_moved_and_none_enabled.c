//@ says: thread 1 at all_axes_moved_and_none_enabled.c:8:5 in `main`: MoveXYZABC: axis 0 is disabled, so nothing moves
//@ says: thread 1 at all_axes_moved_and_none_enabled.c:8:5 in `main`: MoveXYZABC: axis 1 is disabled, so nothing moves
#include "KMotionDef.h"

main()
{
    DefineCoordSystem(0, 1, -1, -1);
    MoveXYZABC(10, 20, 0, 0, 0, 0);
}
