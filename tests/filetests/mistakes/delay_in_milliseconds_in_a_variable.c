//@ args: --for 1
//@ says: thread 1 at delay_in_milliseconds_in_a_variable.c:10:5 in `main`: Delay_sec(250): the thread waits 250 seconds; write Delay_sec(0.001 * ms) for milliseconds
#include "KMotionDef.h"

#define SETTLE_MS 250

main()
{
    int ms = SETTLE_MS;
    Delay_sec(ms);
}
