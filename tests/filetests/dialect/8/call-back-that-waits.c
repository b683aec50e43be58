//@ prints: end
#include "KMotionDef.h"

void tick(void)
{
    if (persist.UserData[9]) printf("tick\n"); //~ call-back-wait: printf
}

main()
{
    UserCallBack = tick;
    WaitNextTimeSlice();
    UserCallBack = 0;
    printf("end\n");
}
//@ cycles: 1285
