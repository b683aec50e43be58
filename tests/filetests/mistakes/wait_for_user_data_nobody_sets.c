//@ args: --for 0.5
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at wait_for_user_data_nobody_sets.c:9:9 in `main` waits for `persist.UserData[50]`: it is 0 (`persist.UserData[50] == 0`), since 0.000 s
#include "KMotionDef.h"

main()
{
    while (persist.UserData[50] == 0)
        WaitNextTimeSlice();
}
