#include "KMotionDef.h"

main()
{
    (void)CheckDone(0);
    MutexLock(&persist.UserData[20]);
    MutexUnlock(&persist.UserData[20]);
}
