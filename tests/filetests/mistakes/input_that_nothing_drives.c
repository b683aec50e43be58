//@ args: --for 0.1
//@ says: thread 1 at input_that_nothing_drives.c:9:13 in `main` reads bit 137, an input that nothing drives; it stays 0
//@ says: at the end, after 0.100 s of board time:
//@ says:   thread 1 at input_that_nothing_drives.c:10:9 in `main` has waited since 0.000 s for bit 137, an input that nothing drives (now 0)
#include "KMotionDef.h"

main()
{
    while (!ReadBit(137))
        WaitNextTimeSlice();
}
