// cc67: run -R no-thread-restarted also 2:pause_counter.c
//
// pause.c - stopping another thread and letting it continue where it was.
//
//   cc67 run 1:c-programs/threads/pause.c 2:c-programs/threads/pause_counter.c
//
// Expect the counter of thread 2 to run, to stop, and to continue from where
// it stood; after a start it begins at 0 again.

#include "KMotionDef.h"

#define COUNTER 40          // persist: thread 2 counts its slices here

void Report(char *What, int Before)
{
    int Now = persist.UserData[COUNTER];
    char *Does = "began again";

    if (Now == Before) Does = "stands still";
    if (Now > Before) Does = "runs";
    printf("%-8s the counter %s\n", What, Does);
}

void Watch(char *What)
{
    int Before = persist.UserData[COUNTER];

    Delay_sec(0.05);
    Report(What, Before);
}

main()
{
    int Before;

    StartThread(2);
    Watch("started:");

    PauseThread(2);
    Watch("paused:");

    if (ResumeThread(2) != 0) printf("nothing is loaded in thread 2\n");
    Watch("resumed:");

    Delay_sec(0.2);                         // counts further than Watch will see
    Before = persist.UserData[COUNTER];
    StartThread(2);
    Delay_sec(0.05);
    Report("restart:", Before);

    PauseThread(2);
}
