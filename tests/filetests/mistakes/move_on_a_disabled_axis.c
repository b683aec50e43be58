//@ says: thread 1 at move_on_a_disabled_axis.c:6:5 in `main`: Move: axis 0 is disabled, so nothing moves
#include "KMotionDef.h"

main()
{
    Move(0, 1000);
}
