//@ args: check
//@ says: warning[lost-swap]: `from` gets its own value back: the value of `to` is lost
//@ says: swap_without_a_third_variable.c:12:20
#include "KMotionDef.h"

main()
{
    double from = persist.UserData[10], to = persist.UserData[11];

    if (from > to)
    {
        to = from; from = to;
    }
    Move(0, from);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Move(0, to);
}
