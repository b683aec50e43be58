//@ says: thread 1 at axis_8.c:7:5 in `main`: EnableAxis(8, …): no such axis (0-7)
#include "KMotionDef.h"

main()
{
    int axis = 8;
    EnableAxis(axis);
}
