//@ args: check
//@ says: warning[early-answer]: this request to the PC replaces one that it has not read
//@ says: second_request_without_a_wait.c:17:5
#include "KMotionDef.h"

void Text(char *text)
{
    sprintf((char *)gather_buffer, text);
    persist.UserData[101] = 0;
}

main()
{
    Text("M5");
    persist.UserData[100] = PC_COMM_MDI;
    Text("G0 X0 Y200");
    persist.UserData[100] = PC_COMM_MDI;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
}
