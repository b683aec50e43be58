//@ says: thread 1 at konnect_at_address_9.c:6:5 in `main`: AddKonnect(9, …): boards have addresses 0 to 7
#include "KMotionDef.h"

main()
{
    AddKonnect(9, &VirtualBits, VirtualBitsEx);
}
