// cc67: part of counter.c
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 20; i++)
    {
        WaitNextTimeSlice();
        persist.UserData[20]++;
    }
    persist.UserData[21] = 1;
}
