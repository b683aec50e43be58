#include "KMotionDef.h"

main()
{
    int last = 0, changes = 0;

    while (persist.UserData[10] >= 0)
    {
        if (persist.UserData[12] != last)
        {
            last = persist.UserData[12];
            changes++;
        }
        persist.UserData[15] = persist.UserData[11] / 10;
    }
    persist.UserData[16] = changes;
}
