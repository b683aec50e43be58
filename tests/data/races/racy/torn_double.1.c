// race-torn: persist.UserData[60] and [61]
#include "KMotionDef.h"

main()
{
    double *feed = (double *)&persist.UserData[60];
    int i;

    for (i = 0; i < 4000; i++)
    {
        *feed = -183.35;  // <-
        *feed = 12.7;     // <-
    }
    persist.UserData[62] = 1;
}
