//@ args: check
//@ says: warning[loop-condition]: this loop never ends if the PC refuses the request
//@ says: wait_until_the_pc_stores_0.c:9:12
#include "KMotionDef.h"

main()
{
    persist.UserData[100] = PC_COMM_ESTOP;
    while (persist.UserData[100] != 0) ;
}
