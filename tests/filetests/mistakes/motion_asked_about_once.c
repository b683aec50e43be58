//@ args: check
//@ says: warning[unused-value]: the result of `CheckDone` is not used
//@ says: motion_asked_about_once.c:10:5
#include "KMotionDef.h"

main()
{
    EnableAxisDest(0, 0);
    Move(0, 1000);
    CheckDone(0);
    printf("there\n");
}
