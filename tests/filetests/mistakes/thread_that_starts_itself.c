//@ prints: once
//@ says: thread 1 at thread_that_starts_itself.c:8:5 in `main`: StartThread(1): the thread is running, so the call has no effect: use a loop to repeat a program
#include "KMotionDef.h"

main()
{
    printf("once\n");
    StartThread(1);
}
