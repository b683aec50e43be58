//@ args: --stim parts/chain_opens.stim --machine parts/chain.toml
//@ prints: stopped
//@ says: thread 1 at delay_in_a_loop_that_guards_a_chain.c:15:12 in `main`: ReadBit(140): this input went off 1500 ms ago, and the loop that read it all the time before was waiting for something else: what has to stop a machine at once needs a loop, or a thread, that does nothing else
#include "KMotionDef.h"

#define CHAIN 140
#define DRIVES 152
#define OIL_PUMP 153

main()
{
    double next = 1.0;

    SetBit(DRIVES);
    while (ReadBit(CHAIN))
    {
        if (Time_sec() > next)
        {
            SetBit(OIL_PUMP);
            Delay_sec(2);
            ClearBit(OIL_PUMP);
            next = Time_sec() + 10;
        }
        WaitNextTimeSlice();
    }
    ClearBit(DRIVES);
    printf("stopped\n");
}
