//@ says: thread 1 at coordinate_system_with_an_axis_twice.c:6:5 in `main`: DefineCoordSystem: [1, 1, -1, -1] names an axis twice
#include "KMotionDef.h"

main()
{
    DefineCoordSystem(1, 1, -1, -1);
}
