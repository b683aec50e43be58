//@ says: thread 1 at snapamp_register_that_is_not_there.c:7:5 in `main`: WriteSnapAmp(0x10): no such register (0x40-0x7f)
#include "KMotionDef.h"

main()
{
    int address = 0x10;
    WriteSnapAmp(address, 0);
}
