//@ args: check
//@ says: warning[milliseconds]: `Delay_sec` waits 500 seconds here
//@ says: delay_in_milliseconds.c:8:15
#include "KMotionDef.h"

main()
{
    Delay_sec(500);
}
