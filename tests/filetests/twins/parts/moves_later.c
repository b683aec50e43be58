#include "KMotionDef.h"

main()
{
    while (persist.UserData[150] == 0) WaitNextTimeSlice();
    Move(0, -1000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
