// order-early: persist.UserData[70]
#include "KMotionDef.h"

main()
{
    double *feed = (double *)&persist.UserData[70];
    int i;

    for (i = 0; i < 100; i++)
    {
        while (persist.UserData[72])
            ;
        persist.UserData[72] = 1;  // <-
        *feed = i * 1.5;  // <-
    }
    persist.UserData[74] = 1;
}
