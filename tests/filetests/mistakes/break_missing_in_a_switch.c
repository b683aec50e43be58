//@ args: check
//@ says: warning[fall-through]: the `case` before continues into this one
//@ says: break_missing_in_a_switch.c:12:5
#include "KMotionDef.h"

main()
{
    switch (persist.UserData[5])
    {
    case 0:
        printf("idle\n");
    case 1:
        printf("run\n");
        break;
    }
}
