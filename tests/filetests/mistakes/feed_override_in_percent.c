//@ says: thread 1 at feed_override_in_percent.c:6:5 in `main`: SetFRO(50): 1 is the programmed speed, so this is 5000 %
#include "KMotionDef.h"

main()
{
    SetFRO(50);
}
