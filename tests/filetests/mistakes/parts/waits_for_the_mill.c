#include "KMotionDef.h"

#define LOADER_READY 60
#define MILL_READY 61

main()
{
    while (!persist.UserData[MILL_READY]) WaitNextTimeSlice();
    persist.UserData[LOADER_READY] = 1;
}
