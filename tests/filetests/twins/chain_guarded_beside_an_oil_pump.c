//@ args: --stim ../mistakes/parts/chain_opens.stim --machine ../mistakes/parts/chain.toml
//@ prints: stopped
#include "KMotionDef.h"

#define CHAIN 140
#define DRIVES 152
#define OIL_PUMP 153

main()
{
    double start = Time_sec() + 1.0, stop = start + 2.0;

    SetBit(DRIVES);
    while (ReadBit(CHAIN))
    {
        if (Time_sec() > stop)
        {
            ClearBit(OIL_PUMP);
            start += 10;
            stop += 10;
        }
        else if (Time_sec() > start)
            SetBit(OIL_PUMP);
        WaitNextTimeSlice();
    }
    ClearBit(DRIVES);
    printf("stopped\n");
}
