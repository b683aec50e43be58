#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 5; i++)
    {
        *(float *)&persist.UserData[101] = 0.9f;
        persist.UserData[100] = PC_COMM_SET_SSO;
        do WaitNextTimeSlice();
        while (persist.UserData[100] > 0);
    }
}
