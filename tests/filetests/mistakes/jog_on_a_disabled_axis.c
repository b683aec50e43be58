//@ says: thread 1 at jog_on_a_disabled_axis.c:6:5 in `main`: Jog: axis 3 is disabled, so nothing moves
#include "KMotionDef.h"

main()
{
    Jog(3, 500);
}
