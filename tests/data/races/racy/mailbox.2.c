#include "KMotionDef.h"

void ask(int code)
{
    persist.UserData[100] = code;  // <-
    do
    {
        WaitNextTimeSlice();
    } while (persist.UserData[100]);
}

main()
{
    int i;

    for (i = 0; i < 5; i++)
        ask(PC_COMM_MCODE);
}
