//@ args: --for 0.5
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at wait_for_an_own_output.c:10:9 in `main` has waited since 0.000 s for bit 20, an output of the board (now 0)
#include "KMotionDef.h"

main()
{
    SetBitDirection(20, 1);
    while (!ReadBit(20))
        WaitNextTimeSlice();
}
