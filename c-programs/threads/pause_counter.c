// cc67: part of pause.c
//
// pause_counter.c - counts the slices it gets, from 0.

#include "KMotionDef.h"

#define COUNTER 40          // persist, read by pause.c

main()
{
    persist.UserData[COUNTER] = 0;
    for (;;)
    {
        WaitNextTimeSlice();
        persist.UserData[COUNTER]++;
    }
}
