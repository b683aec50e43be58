//@ args: check
//@ says: warning[value-range]: bit n of `persist.RunOnStartUp` starts thread n, from 1 to 7, but this is 1
//@ says: start_up_flag_of_thread_0.c:8:5
#include "KMotionDef.h"

main()
{
    persist.RunOnStartUp |= 1;
}
