#include "KMotionDef.h"

main()
{
    int sum = 0;

    for (;;)
    {
        while (persist.UserData[20] == 0)
            ;
        if (persist.UserData[20] < 0)
            break;
        sum += persist.UserData[21] * persist.UserData[22];
        persist.UserData[23] = sum;
        persist.UserData[20] = 0;
    }
}
