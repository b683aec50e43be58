//@ prints: arrived
//@ says: thread 1 at wait_for_another_axis_than_the_one_that_moves.c:15:13 in `main`: CheckDone(0) asks about axis 0, but the thread moves axis 1, for which it never waits
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 2; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        EnableAxisDest(i, 0);
    }
    Move(1, 5000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf("arrived\n");
}
