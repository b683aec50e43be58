//@ args: run 2:parts/runs.c
//@ prints: initialised 5, uninitialised 0, static 1
//@ prints: initialised 6, uninitialised 1, static 2
//@ prints: initialised 7, uninitialised 2, static 3
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 3; i++) {
        persist.UserData[50] = 1;
        StartThread(2);
        while (persist.UserData[50]) WaitNextTimeSlice();
    }
}
