// race-update: persist.UserData[5]
#include "KMotionDef.h"

#define PARTS persist.UserData[5]

main()
{
    int i;

    for (i = 0; i < 3000; i++)
        PARTS++;  // <-
}
