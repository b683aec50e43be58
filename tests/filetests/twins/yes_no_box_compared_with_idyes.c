//@ prints: yes
//@ says: message box: Is the tool clamped? (yes, 6)
#include "KMotionDef.h"

int MsgBox(char *text, int flags)
{
    sprintf((char *)gather_buffer, "%s", text);
    persist.UserData[101] = 0;
    persist.UserData[102] = flags;
    persist.UserData[100] = PC_COMM_MSG;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
    return persist.UserData[103];
}

main()
{
    int answer = MsgBox("Is the tool clamped?", MB_YESNO | MB_ICONQUESTION);
    if (answer == IDYES) printf("yes\n");
    if (answer == IDNO) printf("no\n");
}
