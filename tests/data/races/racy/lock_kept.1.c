// lock-kept: persist.UserData[9]
#include "KMotionDef.h"

int job(int i)
{
    MutexLock(&persist.UserData[9]);  // <-
    if (i == 7)
        return 1;
    persist.UserData[5]++;
    MutexUnlock(&persist.UserData[9]);
    return 0;
}

main()
{
    int i;

    for (i = 0; i < 20; i++)
        if (job(i))
            break;
}
