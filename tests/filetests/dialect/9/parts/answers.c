// Stores through the address that the other program left in persist.UserData[60].
#include "KMotionDef.h"

main()
{
    while (persist.UserData[60] == 0) WaitNextTimeSlice();
    Delay_sec(0.005);
    *(double *)persist.UserData[60] = 2.5;
    Delay_sec(0.005);
    persist.UserData[3] = 1;
}
