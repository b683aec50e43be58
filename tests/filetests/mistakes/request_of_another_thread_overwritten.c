//@ args: --for 1 2:parts/asks_too.c
//@ says: thread 2 at asks_too.c:10:12 in `main`: request 5 of another thread is overwritten with 21 before the PC has answered it: threads share persist.UserData[100], so use a mutex
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 5; i++)
    {
        *(float *)&persist.UserData[101] = 0.5f;
        persist.UserData[100] = PC_COMM_SET_FRO;
        do WaitNextTimeSlice();
        while (persist.UserData[100] > 0);
    }
}
