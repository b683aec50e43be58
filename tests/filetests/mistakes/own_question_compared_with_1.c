//@ args: check
//@ says: warning[box-answer]: a box with the buttons of `MB_YESNO` never answers 1
//@ says: own_question_compared_with_1.c:16:9
#include "KMotionDef.h"

int Question(void)
{
    persist.UserData[PC_COMM_PERSIST + 2] = MB_YESNO;
    persist.UserData[PC_COMM_PERSIST] = PC_COMM_MSG;
    while (persist.UserData[PC_COMM_PERSIST] > 0) WaitNextTimeSlice();
    return persist.UserData[PC_COMM_PERSIST + 3];
}

main()
{
    if (Question() == 1) SetBit(46);
}
