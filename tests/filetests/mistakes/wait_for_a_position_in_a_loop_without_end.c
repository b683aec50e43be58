//@ args: --for 0.5
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at wait_for_a_position_in_a_loop_without_end.c:8:12 in `main` has waited since 0.000 s for `ch0->Position` (now 0) in `ch0->Position < 100`
#include "KMotionDef.h"

main()
{
    while (ch0->Position < 100)
        ;
}
