//@ says: thread 1 at bit_number_too_high.c:6:5 in `main`: SetBit(3000): no such bit (0-2047)
#include "KMotionDef.h"

main()
{
    SetBit(3000);
}
