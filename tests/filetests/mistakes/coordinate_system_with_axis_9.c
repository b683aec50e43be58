//@ says: thread 1 at coordinate_system_with_axis_9.c:6:5 in `main`: DefineCoordSystem: [0, 9, -1, -1] must be axes 0 to 7 or -1
#include "KMotionDef.h"

main()
{
    DefineCoordSystem(0, 9, -1, -1);
}
