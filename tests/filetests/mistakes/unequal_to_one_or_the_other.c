//@ args: check
//@ says: warning[constant-comparison]: this condition is always true
//@ says: unequal_to_one_or_the_other.c:9:9
#include "KMotionDef.h"

main()
{
    int mode = persist.UserData[5];
    if (mode != 1 || mode != 2) printf("unknown mode\n");
}
