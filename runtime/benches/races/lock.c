/* Changes an element under a lock, and does something else for a while. */
#include "KMotionDef.h"

double own[64];

main()
{
    int i;

    for (;;)
    {
        MutexLock(&persist.UserData[20]);
        persist.UserData[21]++;
        MutexUnlock(&persist.UserData[20]);
        for (i = 0; i < 64; i++)
            own[i] += i;
    }
}
