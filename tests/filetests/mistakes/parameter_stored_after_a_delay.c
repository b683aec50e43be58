//@ args: check
//@ says: warning[early-answer]: `persist.UserData[102]` is stored after the request to the PC
//@ says: parameter_stored_after_a_delay.c:12:5
#include "KMotionDef.h"

main()
{
    sprintf((char *)gather_buffer, "Is the tool clamped?");
    persist.UserData[101] = 0;
    persist.UserData[100] = PC_COMM_MSG;
    Delay_sec(0.01);
    persist.UserData[102] = MB_YESNO;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
    if (persist.UserData[103] == IDYES) SetBit(47);
}
