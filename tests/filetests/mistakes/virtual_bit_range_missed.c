//@ says: thread 1 at virtual_bit_range_missed.c:7:5 in `main`: SetBit(188): nothing is connected to bit 188: it reads 0 and cannot be written
#include "KMotionDef.h"

main()
{
    SetBitDirection(47, 1);
    SetBit(48 + 140);
}
