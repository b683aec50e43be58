// race-update: persist.UserData[70]
#include "KMotionDef.h"

float *total = (float *)&persist.UserData[70];

main()
{
    int i;

    for (i = 0; i < 2000; i++)
        *total = *total + 0.5f;  // <-
}
