// race-store: persist.UserData[42]
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 5000; i++)
        persist.UserData[42]++;  // <-
}
