//@ args: check
//@ says: warning[unused-value]: `,` ends the number: 0 is stored, and 25 is dropped
//@ says: comma_in_place_of_a_decimal_point.c:9:17
#include "KMotionDef.h"

main()
{
    double seconds;
    seconds = 0,25;
    Delay_sec(seconds);
}
