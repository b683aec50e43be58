#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 2; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        chan[i].OutputChan0 = 8;
    }
    EnableAxisDest(0, 0);
    DisableAxis(0);
    EnableAxisDest(1, 0);
}
