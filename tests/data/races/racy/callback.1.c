// race-call-back: pulses
#include "KMotionDef.h"

int pulses;

void each_tick(void)
{
    pulses++;  // <-
}

main()
{
    int taken = 0, i;

    UserCallBack = each_tick;
    for (i = 0; i < 4000; i++)
    {
        pulses -= pulses > 3 ? 3 : 0;  // <-
        taken += 3;
    }
    UserCallBack = NULL;
}
