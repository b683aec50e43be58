//@ args: check
//@ says: warning[idle-loop]: this loop only tests `done`, which nothing in it changes
//@ says: loop_on_a_local_that_nothing_changes.c:9:12
#include "KMotionDef.h"

main()
{
    int done = 0;
    while (!done)
        ;
}
