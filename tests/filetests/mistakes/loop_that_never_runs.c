//@ args: check
//@ says: warning[loop-condition]: this loop never runs
//@ says: loop_that_never_runs.c:9:17
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i == 7; i++) EnableAxis(i);
}
