//@ args: check
#include "KMotionDef.h"

main()
{
    persist.UserData[102] = 4;
    persist.UserData[101] = 2000;
    persist.UserData[100] = PC_COMM_INPUT;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
    printf("%.1f\n", *(float *)&persist.UserData[102]);
}
