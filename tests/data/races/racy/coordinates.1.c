// race-shared: the coordinate system
#include "KMotionDef.h"

main()
{
    int i;

    DefineCoordSystem(0, 1, 2, -1);
    for (i = 0; i < 3; i++)
        EnableAxis(i);
    for (i = 0; i < 3; i++)
    {
        MoveXYZABC(i, i, 0, 0, 0, 0);  // <-
        while (!CheckDoneXYZABC())
            ;
    }
}
