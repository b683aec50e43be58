//@ args: 2:../mistakes/parts/calls_back_too.c
#include "KMotionDef.h"

int n;

void Tick(void)
{
    n++;
}

main()
{
    UserCallBack = Tick;
    Delay_sec(0.005);
    UserCallBack = 0;
}
