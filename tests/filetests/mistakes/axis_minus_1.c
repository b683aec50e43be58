//@ prints: Attempt to Disable invalid Chan
//@ says: thread 1 at axis_minus_1.c:9:5 in `main`: Move(-1, …): no such axis (0-7)
#include "KMotionDef.h"

main()
{
    int axis = -1;
    DisableAxis(axis);
    Move(axis, 10);
}
