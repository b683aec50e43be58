//@ args: --stim parts/chain_opens_late.stim
//@ prints: emergency stop
//@ says: at 0.5 s, but the run ended at 0.000 s; bit 140 is 0 without it: `idle_high = [140]` under `[inputs]` of the machine file makes an input 1 at rest
//@ says: chain_opens_late.stim:1:1
#include "KMotionDef.h"

main()
{
    while (Time_sec() < 1.0)
    {
        if (!ReadBit(140))
        {
            printf("emergency stop\n");
            return;
        }
        WaitNextTimeSlice();
    }
}
