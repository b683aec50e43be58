//@ args: check
//@ says: warning[unreachable-code]: this statement is never executed
//@ says: statements_after_an_endless_loop.c:13:5
#include "KMotionDef.h"

main()
{
    for (;;)
    {
        WaitNextTimeSlice();
        if (ReadBit(46)) SetBit(47);
    }
    ClearBit(47);
}
