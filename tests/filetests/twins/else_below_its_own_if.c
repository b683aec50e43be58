//@ prints: none
#include "KMotionDef.h"

main()
{
    if (persist.UserData[20] == 0)
        if (persist.UserData[21])
            printf("the second\n");
        else
            printf("none\n");
}
