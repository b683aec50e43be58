// cc67: run also 2:rerun_part.c
//
// rerun.c - what a program finds when it is started again without a download.
//
//   cc67 run 1:c-programs/threads/rerun.c 2:c-programs/threads/rerun_part.c
//
// Initial values of globals are written by the download, not by the start.
//
// Expect the global of thread 2 to continue (11, 12, 13) although its source says 10,
// and its local to begin at 0 each time.

#include "KMotionDef.h"

#define GO 50               // persist: 1 = thread 2 shall run, 0 = it has run

main()
{
    int i;

    for (i = 0; i < 3; i++)
    {
        persist.UserData[GO] = 1;
        StartThread(2);
        while (persist.UserData[GO] != 0) WaitNextTimeSlice();
    }
}
