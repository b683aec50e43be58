//@ args: check
//@ says: warning[box-answer]: a box with the buttons of `MB_YESNO` never answers 1
//@ says: question_of_an_own_function_compared_with_1.c:28:9
#include "KMotionDef.h"

void Ask(int code)
{
    persist.UserData[PC_COMM_PERSIST] = code;
    while (persist.UserData[PC_COMM_PERSIST] > 0) WaitNextTimeSlice();
}

int Box(char *text, int style)
{
    sprintf((char *)gather_buffer + 4000, text);
    persist.UserData[101] = 1000;
    persist.UserData[102] = style;
    Ask(PC_COMM_MSG);
    return persist.UserData[103];
}

int IsToBeOff(void)
{
    return Box("Switch the coolant off?", MB_YESNO);
}

main()
{
    if (IsToBeOff() == 1)
        ClearBit(152);
}
