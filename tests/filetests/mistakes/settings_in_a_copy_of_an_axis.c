//@ args: check
//@ says: warning[unused-copy]: `c` is a copy of `chan[axis]`: values stored in it stay in the copy
//@ says: settings_in_a_copy_of_an_axis.c:9:5
#include "KMotionDef.h"

void Setup(int axis, double speed)
{
    CHAN c = chan[axis];
    c.OutputMode = STEP_DIR_MODE;
    c.Vel = speed;
    EnableAxisDest(axis, 0);
}

main()
{
    Setup(0, 20000);
}
