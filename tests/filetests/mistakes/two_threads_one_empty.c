//@ says: thread 1 at two_threads_one_empty.c:9:9 in `main`: StartThread(2): no program is loaded in thread 2
//@ says: thread 1 at two_threads_one_empty.c:9:9 in `main`: StartThread(3): no program is loaded in thread 3
#include "KMotionDef.h"

main()
{
    int thread;
    for (thread = 2; thread < 4; thread++)
        StartThread(thread);
}
