#include "KMotionDef.h"

main()
{
    double *feed = (double *)&persist.UserData[60];
    double f;
    int torn = 0;

    while (!persist.UserData[62])
    {
        f = *feed;  // <-
        if (f != 12.7 && f != -183.35 && f != 0.0)
            torn++;
    }
    if (torn > 1000000)
        printf("%d\n", torn);
}
