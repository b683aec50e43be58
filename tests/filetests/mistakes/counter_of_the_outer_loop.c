//@ args: check
//@ says: warning[loop-condition]: this loop changes `i`, the counter of the enclosing loop
//@ says: counter_of_the_outer_loop.c:11:28
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 8; i++)
    {
        for (i = 0; i < 3; i++) printf("%d\n", i);
    }
}
