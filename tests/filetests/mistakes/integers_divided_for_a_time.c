//@ args: check
//@ says: warning[integer-division]: `1/10` is 0: integer division drops the fraction
//@ says: integers_divided_for_a_time.c:8:15
#include "KMotionDef.h"

main()
{
    Delay_sec(1/10);
}
