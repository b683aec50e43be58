// cc67: run --for 5 also 2:start_2.c
#include "KMotionDef.h"

main()
{
    int i;

    persist.UserData[35] = 250;
    while (!persist.UserData[36])
        WaitNextTimeSlice();
    printf("speed %d\n", persist.UserData[36]);
}
