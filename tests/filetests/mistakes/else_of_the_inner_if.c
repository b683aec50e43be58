//@ args: check
//@ says: warning[dangling-else]: this `else` belongs to the second `if`
//@ says: else_of_the_inner_if.c:10:5
#include "KMotionDef.h"

main()
{
    if (persist.UserData[20])
        if (persist.UserData[21]) printf("both\n");
    else
        printf("the first is 0\n");
}
