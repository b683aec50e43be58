#include "KMotionDef.h"

main()
{
    int sum = 0, out = persist.UserData[111];

    for (;;)
    {
        if (out != persist.UserData[110])
        {
            sum += persist.UserData[112 + (out & 7)];
            out++;
            persist.UserData[111] = out;
        }
        else if (persist.UserData[121])
            break;
    }
    persist.UserData[122] = sum;
}
