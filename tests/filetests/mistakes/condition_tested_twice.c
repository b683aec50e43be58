//@ args: check
//@ says: warning[duplicated-condition]: this condition was tested before
//@ says: condition_tested_twice.c:11:14
#include "KMotionDef.h"

main()
{
    int key = persist.UserData[20];
    if (key == 1) printf("left\n");
    else if (key == 2) printf("right\n");
    else if (key == 1) printf("stop\n");
}
