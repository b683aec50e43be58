// cc67: part of rerun.c
//
// rerun_part.c - counts its runs in a global and in a local variable.

#include "KMotionDef.h"

#define GO 50               // persist, set by rerun.c

int Runs = 10;

main()
{
    int Local = 0;

    if (persist.UserData[GO] == 0) ThreadDone();    // not requested

    Runs++;
    Local++;
    printf("global %d, local %d\n", Runs, Local);

    persist.UserData[GO] = 0;
}
