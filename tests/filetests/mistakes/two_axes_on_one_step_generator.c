//@ says: thread 1 at two_axes_on_one_step_generator.c:12:9 in `main`: EnableAxisDest: axis 1 drives step generator 0, which axis 0 drives too: give each axis an OutputChan0 of its own
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 2; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        chan[i].OutputChan0 = 8;
        EnableAxisDest(i, 0);
    }
}
