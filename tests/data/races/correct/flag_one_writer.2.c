#include "KMotionDef.h"

main()
{
    int seen = 0;

    while (!persist.UserData[6])
        if (persist.UserData[5])
            seen++;
    persist.UserData[7] = seen;
}
