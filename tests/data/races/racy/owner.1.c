// race-claim: persist.UserData[30]
#include "KMotionDef.h"

#define OWNER persist.UserData[30]

main()
{
    int i;

    for (i = 0; i < 500; i++)
    {
        while (OWNER != 0)
            ;
        OWNER = 1;  // <-
        persist.UserData[31] = i;
        OWNER = 0;
    }
}
