//@ args: check
//@ says: warning[loop-condition]: `i` counts down, away from the end of the loop
//@ says: loop_that_counts_away.c:9:24
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 7; i--) EnableAxis(i);
}
