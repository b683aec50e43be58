//@ args: --for 0.5
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at wait_for_a_virtual_bit.c:9:9 in `main` has waited since 0.000 s for bit 1040, which only programs set (now 0)
#include "KMotionDef.h"

main()
{
    while (!ReadBit(1040))
        WaitNextTimeSlice();
}
