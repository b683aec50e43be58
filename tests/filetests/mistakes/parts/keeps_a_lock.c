#include "KMotionDef.h"

main()
{
    MutexLock((int *)&persist.UserData[30]);
    if (persist.UserData[31] == 0) return 0;
    MutexUnlock((int *)&persist.UserData[30]);
}
