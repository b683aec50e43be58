//@ args: --for 0.5
//@ says: thread 1 at thread_that_pauses_itself.c:7:5 in `main`: PauseThread(1): the thread pauses itself, until another one calls ResumeThread(1)
#include "KMotionDef.h"

main()
{
    PauseThread(1);
    printf("never\n");
}
