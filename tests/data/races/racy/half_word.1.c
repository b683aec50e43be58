// race-update: persist.UserData[50]
#include "KMotionDef.h"

short *load = (short *)&persist.UserData[50];

main()
{
    int i;

    for (i = 0; i < 2000; i++)
        load[0] += 1;  // <-
}
