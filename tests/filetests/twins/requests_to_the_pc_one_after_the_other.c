//@ args: --set persist.10=f:1.5
//@ prints: 1.5
//@ says: enable jog keys
//@ says: restart the job
#include "KMotionDef.h"

main()
{
    printf("%g\n", *(float *)&persist.UserData[10]);
    persist.UserData[100] = 37;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
    persist.UserData[100] = 20;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
}
