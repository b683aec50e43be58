// race-request: persist.UserData[100]
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 5; i++)
    {
        persist.UserData[101] = i;
        persist.UserData[100] = PC_COMM_MDI;  // <-
        while (persist.UserData[100])
            ;
    }
}
