//@ prints: 5000
#include "KMotionDef.h"

main()
{
    int i, moving;
    for (i = 0; i < 2; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        chan[i].OutputChan0 = i;
        EnableAxisDest(i, 0);
    }
    Move(1, 5000);
    do
    {
        WaitNextTimeSlice();
        moving = 0;
        for (i = 0; i < 2; i++) if (CheckDone(i) == 0) moving = 1;
    } while (moving);
    printf("%.0f\n", ch1->Dest);
}
