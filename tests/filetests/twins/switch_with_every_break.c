//@ args: check
#include "KMotionDef.h"

main()
{
    switch (persist.UserData[5])
    {
    case 0:
        printf("idle\n");
        break;
    case 1:
    case 2:
        printf("run\n");
        break;
    default:
        printf("stop\n");
    }
}
