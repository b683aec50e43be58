#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 3; i++)
    {
        MoveXYZABC(-i, 2 * i, 0, 0, 0, 0);  // <-
        while (!CheckDoneXYZABC())
            ;
    }
}
