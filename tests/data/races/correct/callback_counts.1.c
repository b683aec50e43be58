#include "KMotionDef.h"

volatile int ticks;
volatile int stop;

void each_tick(void)
{
    if (!stop)
        ticks++;
}

main()
{
    int start = ticks;

    UserCallBack = each_tick;
    while (ticks - start < 50)
        ;
    stop = 1;
    UserCallBack = NULL;
}
