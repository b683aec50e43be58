//@ says: thread 1 at request_replaced_before_the_pc_has_seen_it.c:9:39 in `main`: request 37 is replaced by 20 before the PC has answered it, and is lost: wait until persist.UserData[100] is no longer positive (noticed at this call)
#include "KMotionDef.h"

main()
{
    persist.UserData[100] = 37;
    Delay_sec(0.01);
    persist.UserData[100] = 20;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
}
