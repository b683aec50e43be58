//@ args: --for 0.5
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at wait_for_a_virtual_bit.c:9:9 in `main` waits for bit 1040, which only programs set: it is 0, since 0.000 s
#include "KMotionDef.h"

main()
{
    while (!ReadBit(1040))
        WaitNextTimeSlice();
}
