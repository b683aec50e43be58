/* Waits for a request and clears it. */
#include "KMotionDef.h"

main()
{
    for (;;)
    {
        while (!persist.UserData[70])
            ;
        persist.UserData[70] = 0;
    }
}
