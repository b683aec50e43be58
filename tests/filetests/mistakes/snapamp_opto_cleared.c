//@ says: thread 1 at snapamp_opto_cleared.c:6:5 in `main`: ClearBit(72): bit 72 is an input, so nothing changes
#include "KMotionDef.h"

main()
{
    ClearBit(72);
}
