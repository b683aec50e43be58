#include "KMotionDef.h"

main()
{
    double *feed = (double *)&persist.UserData[70], sum = 0;

    while (!persist.UserData[74])
    {
        if (persist.UserData[72])
        {
            sum += *feed;
            persist.UserData[72] = 0;
        }
    }
    persist.UserData[75] = sum;
}
