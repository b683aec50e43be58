//@ says: thread 1 at state_of_a_kanalog_input_set.c:6:5 in `main`: SetStateBit(128): bit 128 is an input, so nothing changes
#include "KMotionDef.h"

main()
{
    SetStateBit(128, 1);
}
