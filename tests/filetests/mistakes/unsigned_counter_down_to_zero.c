//@ args: check
//@ says: warning[constant-comparison]: this comparison is always true
//@ says: unsigned_counter_down_to_zero.c:9:20
#include "KMotionDef.h"

main()
{
    unsigned axis;
    for (axis = 7; axis >= 0; axis--) DisableAxis(axis);
}
