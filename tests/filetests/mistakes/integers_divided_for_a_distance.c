//@ args: check
//@ says: warning[integer-division]: `1/2` is 0: integer division drops the fraction
//@ says: integers_divided_for_a_distance.c:8:16
#include "KMotionDef.h"

main()
{
    MoveRel(0, 1/2*1000);
}
