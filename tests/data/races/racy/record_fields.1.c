// race-record:
#include "KMotionDef.h"

#define X persist.UserData[85]
#define Y persist.UserData[86]
#define Z persist.UserData[87]

main()
{
    int i, k;

    for (i = 0; i < 3000; i++)
    {
        X = 3 * i;
        Y = 4 * i;  // <-
        Z = 5 * i;  // <-
        for (k = 0; k < i % 11; k++)
            ;
    }
    persist.UserData[88] = 1;
}
