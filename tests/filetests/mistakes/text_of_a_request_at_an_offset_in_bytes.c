//@ says: request 18: no text is at word 160 of the gather buffer, but there is one at 160 bytes: the offset counts words of 4 bytes, so store 40 in persist.UserData[101]
#include "KMotionDef.h"

main()
{
    sprintf((char *)gather_buffer + 160, "M3 S1000");
    persist.UserData[101] = 160;
    persist.UserData[100] = 18;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
}
