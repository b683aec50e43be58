//@ args: --for 1 --stim parts/replaced.stim
//@ prints: spindle on
//@ says: the program of thread 1 is still running and is replaced by another one: what it watched is not watched any more
#include "KMotionDef.h"

main()
{
    for (;;)
    {
        WaitNextTimeSlice();
        if (!ReadBit(136)) DisableAxis(0);
    }
}
