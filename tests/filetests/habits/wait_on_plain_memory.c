// Empty loops wait on values that only another thread changes.
//@ args: run 2:parts/feeder.c
//@ prints: ready
//@ prints: fed 25.40
#include "KMotionDef.h"

#define READY 90
#define FED 92

main()
{
    persist.UserData[READY] = 0;
    persist.UserData[READY + 1] = 1;
    while (persist.UserData[READY] == 0) ;
    printf("ready\n");
    while (((float *)persist.UserData)[FED] == 0.0)
        ;
    printf("fed %.2f\n", *(float *)&persist.UserData[FED]);
}
