#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 100; i++)
    {
        while (persist.UserData[14] < 5)
            ;
        persist.UserData[14] = 0;
    }
}
