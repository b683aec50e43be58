//@ args: check
//@ says: warning[shadow]: this `bestPos` shadows the `bestPos` of the block around it
//@ says: best_value_in_an_inner_block.c:16:20
#include "KMotionDef.h"

main()
{
    int i;
    double best = 0.0, bestPos = 0.0;
    for (i = 0; i <= 10; i++)
    {
        double signal = ReadADC(0);
        if (signal > best)
        {
            double best = signal;
            double bestPos = ch0->Dest;
        }
    }
    Move(0, bestPos);
}
