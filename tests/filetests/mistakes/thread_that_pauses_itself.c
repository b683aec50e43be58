//@ args: --for 0.5
//@ prints: in the same slice
//@ says: thread 1 at thread_that_pauses_itself.c:8:5 in `main`: PauseThread(1): the thread pauses itself, until another one calls ResumeThread(1)
#include "KMotionDef.h"

main()
{
    PauseThread(1);
    printf("in the same slice\n");
    WaitNextTimeSlice();
    printf("never\n");
}
