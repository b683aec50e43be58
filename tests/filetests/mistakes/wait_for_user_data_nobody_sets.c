//@ args: --for 0.5
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at wait_for_user_data_nobody_sets.c:9:9 in `main` has waited since 0.000 s for `persist.UserData[50]` (now 0) in `persist.UserData[50] == 0`
#include "KMotionDef.h"

main()
{
    while (persist.UserData[50] == 0)
        WaitNextTimeSlice();
}
