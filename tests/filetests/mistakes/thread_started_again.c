//@ args: 2:parts/takes_a_second.c
//@ says: thread 1 at thread_started_again.c:9:5 in `main`: StartThread(2): thread 2 is active, so it begins again, and what it had half done stays half done
#include "KMotionDef.h"

main()
{
    StartThread(2);
    Delay_sec(0.5);
    StartThread(2);
}
