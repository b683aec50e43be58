//@ says: request 15: persist.UserData[101] is the address of a text, but the PC reads texts in the gather buffer alone: copy it there, and store its offset in words
#include "KMotionDef.h"

main()
{
    persist.UserData[101] = (int)"Is the tool clamped?";
    persist.UserData[102] = MB_OK;
    persist.UserData[100] = PC_COMM_MSG;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
}
