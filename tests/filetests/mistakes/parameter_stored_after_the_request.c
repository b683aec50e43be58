//@ args: check
//@ says: warning[early-answer]: `persist.UserData[101]` is stored after the request to the PC
//@ says: parameter_stored_after_the_request.c:9:5
#include "KMotionDef.h"

main()
{
    persist.UserData[100] = PC_COMM_SET_FRO;
    *(float *)&persist.UserData[101] = 0.5;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
}
