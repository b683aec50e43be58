/* Looks at an axis and at how far another thread has come. */
#include "KMotionDef.h"

main()
{
    int last = 0, n = 0;

    for (;;)
    {
        if (persist.UserData[50] != last)
        {
            last = persist.UserData[50];
            n++;
        }
        if (chan[0].Position - chan[0].Dest > 1000)
            n++;
        persist.UserData[61] = n;
    }
}
