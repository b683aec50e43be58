//@ says: thread 1 at opto_input_written.c:6:5 in `main`: SetBit(136): bit 136 is an input, so nothing changes
#include "KMotionDef.h"

main()
{
    SetBit(136);
}
