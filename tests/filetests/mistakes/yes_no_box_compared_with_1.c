//@ args: check
//@ says: warning[box-answer]: a box with the buttons of `MB_YESNO` never answers 1
//@ says: yes_no_box_compared_with_1.c:13:9
#include "KMotionDef.h"

main()
{
    sprintf((char *)gather_buffer, "Is the tool clamped?");
    persist.UserData[101] = 0;
    persist.UserData[102] = MB_YESNO;
    persist.UserData[100] = PC_COMM_MSG;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
    if (persist.UserData[103] == TRUE) SetBit(47);
}
