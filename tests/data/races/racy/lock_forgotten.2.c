#include "KMotionDef.h"

main()
{
    int i, n;

    for (i = 0; i < 1000; i++)
    {
        n = persist.UserData[5];
        persist.UserData[5] = n + 1;  // <-
    }
}
