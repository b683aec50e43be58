//@ args: check
//@ says: warning[power]: `^` is exclusive or, not a power
//@ says: power_after_a_factor.c:8:18
#include "KMotionDef.h"

main()
{
    ch0->Accel = 2 * 10^5;
}
