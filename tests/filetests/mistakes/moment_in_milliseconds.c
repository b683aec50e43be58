//@ args: --for 2 --stim parts/after_500.stim
//@ says: never happened: parts/after_500.stim:1:1: at 500 s, but the run ended at 2.000 s (milliseconds are `500ms`)
//@ says: moment_in_milliseconds.c:9:9 in `main` has waited since 0.000 s for bit 140 (now 0)
#include "KMotionDef.h"

main()
{
    while (!ReadBit(140))
        WaitNextTimeSlice();
}
