//@ args: 2:parts/measures.c
//@ prints: yes 42
//@ says: message box: Is the tool clamped?
#include "KMotionDef.h"

main()
{
    sprintf((char *)gather_buffer, "Is the tool clamped?");
    persist.UserData[101] = 0;
    persist.UserData[102] = MB_YESNO;
    persist.UserData[100] = PC_COMM_MSG;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
    if (persist.UserData[103] == IDYES) printf("yes ");
    persist.UserData[11] = 0;
    StartThread(2);
    while (!persist.UserData[11]) WaitNextTimeSlice();
    printf("%d\n", persist.UserData[10]);
}
