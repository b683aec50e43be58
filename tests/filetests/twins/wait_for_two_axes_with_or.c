//@ prints: 3000 5000
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 2; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        chan[i].OutputChan0 = i;
        EnableAxisDest(i, 0);
    }
    MoveRel(0, 3000);
    MoveRel(1, 5000);
    while (!CheckDone(0) || !CheckDone(1)) WaitNextTimeSlice();
    printf("%.0f %.0f\n", ch0->Dest, ch1->Dest);
}
