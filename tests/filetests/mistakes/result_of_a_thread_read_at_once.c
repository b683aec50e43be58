//@ args: check
//@ says: warning[early-answer]: `persist.UserData[10]` is read before the thread that was started has run
//@ says: result_of_a_thread_read_at_once.c:10:29
#include "KMotionDef.h"

main()
{
    persist.UserData[10] = 0;
    StartThread(2);
    printf("measured %d\n", persist.UserData[10]);
}
