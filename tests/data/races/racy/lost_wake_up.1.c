// pause-overtaken: persist.UserData[33]
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 20; i++)
    {
        if (!persist.UserData[33])
            PauseThread(1);  // <-
        persist.UserData[33] = 0;
    }
}
