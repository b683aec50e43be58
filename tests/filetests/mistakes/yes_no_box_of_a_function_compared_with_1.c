//@ prints: not clear
//@ says: message box: Is the vise clear? (yes, 6)
#include "KMotionDef.h"

int Question(char *text)
{
    sprintf((char *)gather_buffer, "%s", text);
    persist.UserData[101] = 0;
    persist.UserData[102] = MB_YESNO;
    persist.UserData[100] = PC_COMM_MSG;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
    return persist.UserData[103];
}

main()
{
    if (Question("Is the vise clear?") == 1) printf("clear\n");
    else printf("not clear\n");
}
