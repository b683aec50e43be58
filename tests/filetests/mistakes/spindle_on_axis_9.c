//@ says: thread 1 at spindle_on_axis_9.c:6:5 in `main`: ConfigureSpindle: no such axis (0-7): 9
#include "KMotionDef.h"

main()
{
    ConfigureSpindle(1, 9, 0.2, 0.1, 4000);
}
