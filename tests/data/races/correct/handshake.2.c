#include "KMotionDef.h"

main()
{
    while (!persist.UserData[71])
    {
        if (persist.UserData[70])
        {
            Delay_sec(0.0002);
            persist.UserData[70] = 0;
        }
    }
}
