//@ args: check
//@ says: warning[early-answer]: `persist.UserData[103]` is read before the PC has answered
//@ says: answer_of_the_pc_read_at_once.c:12:9
#include "KMotionDef.h"

main()
{
    sprintf((char *)gather_buffer, "Is the tool clamped?");
    persist.UserData[101] = 0;
    persist.UserData[102] = MB_YESNO;
    persist.UserData[100] = PC_COMM_MSG;
    if (persist.UserData[103] == IDYES) SetBit(47);
}
