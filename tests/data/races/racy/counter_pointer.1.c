// race-update: persist.UserData[90]
#include "KMotionDef.h"

main()
{
    int *parts = &persist.UserData[90], i;

    for (i = 0; i < 3000; i++)
        *parts = *parts + 2;  // <-
}
