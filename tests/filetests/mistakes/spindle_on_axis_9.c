//@ says: thread 1 at spindle_on_axis_9.c:6:5 in `main`: ConfigureSpindle: axis 9; there are axes 0 to 7
#include "KMotionDef.h"

main()
{
    ConfigureSpindle(1, 9, 0.2, 0.1, 4000);
}
