//@ args: 2:parts/calls_back_too.c
//@ says: UserCallBack of thread 1 is replaced by a function of thread 2: the board has only one call-back
#include "KMotionDef.h"

int n;

void Tick(void)
{
    n++;
}

main()
{
    UserCallBack = Tick;
    Delay_sec(0.2);
    UserCallBack = 0;
}
