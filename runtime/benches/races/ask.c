/* Sets a request and waits for the answer. */
#include "KMotionDef.h"

main()
{
    for (;;)
    {
        persist.UserData[70] = 1;
        while (persist.UserData[70])
            ;
    }
}
