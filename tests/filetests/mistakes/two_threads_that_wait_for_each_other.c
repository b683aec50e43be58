//@ args: 2:parts/waits_for_the_mill.c --for 0.5
//@ says: for `persist.UserData[LOADER_READY]` (now 0) in `!persist.UserData[LOADER_READY]`, which thread 2 sets at parts/waits_for_the_mill.c:9, after its own wait
//@ says: for `persist.UserData[MILL_READY]` (now 0) in `!persist.UserData[MILL_READY]`, which thread 1 sets at two_threads_that_wait_for_each_other.c:13, after its own wait
//@ says: two_threads_that_wait_for_each_other.c:12:45
#include "KMotionDef.h"

#define LOADER_READY 60
#define MILL_READY 61

main()
{
    while (!persist.UserData[LOADER_READY]) WaitNextTimeSlice();
    persist.UserData[MILL_READY] = 1;
}
